// A panel that looks at its document once a turn of the event loop at most, and not while it is hidden.
#pragma once

#include <QWidget>

namespace tessera {

class LazyPanel : public QWidget {
    Q_OBJECT

  public:
    using QWidget::QWidget;

  protected:
    // Shows what there is to see now.
    virtual void refresh() = 0;
    // Refreshes when the present events are through (a marquee changes the selection with each move), or when
    // the panel is shown.
    void refreshSoon();
    void refreshNow();
    void showEvent(QShowEvent* event) override;

  private:
    bool mStale = false;
};

}  // namespace tessera
