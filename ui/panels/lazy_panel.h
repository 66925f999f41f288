// A panel that looks at its document once a turn of the event loop at most, and not while nothing of it can
// be seen, be it hidden or behind the tab of another one.
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
    // the panel is seen again.
    void refreshSoon();
    void refreshNow();
    void showEvent(QShowEvent* event) override;
    void paintEvent(QPaintEvent* event) override;

  private:
    void refreshNext();

    bool mStale = false;
};

}  // namespace tessera
