// See lazy_panel.h.
#include "ui/panels/lazy_panel.h"

#include <QTimer>
#include <utility>

namespace tessera {

void LazyPanel::refreshSoon() {
    // A dock behind another one's tab is not hidden: it lies outside the window.
    if (!std::exchange(mStale, true) && !visibleRegion().isEmpty()) refreshNext();
}

void LazyPanel::refreshNext() {
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

void LazyPanel::paintEvent(QPaintEvent* event) {
    QWidget::paintEvent(event);
    // The panel comes from behind a tab: what it shows is changed when it is painted.
    if (mStale) refreshNext();
}

}  // namespace tessera
