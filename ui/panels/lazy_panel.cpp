// See lazy_panel.h.
#include "ui/panels/lazy_panel.h"

#include <QTimer>
#include <utility>

namespace tessera {

void LazyPanel::refreshSoon() {
    if (!std::exchange(mStale, true) && isVisible())
        QTimer::singleShot(0, this, [this] {
            if (mStale) refreshNow();
        });
}

void LazyPanel::refreshNow() {
    mStale = false;
    refresh();
}

void LazyPanel::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    if (mStale) refreshNow();
}

}  // namespace tessera
