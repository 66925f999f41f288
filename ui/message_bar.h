// One sentence across the top of the canvas: what went wrong or well, never in the way.
#pragma once

#include <QFrame>
#include <QTimer>

#include "app/message.h"

class QLabel;
class QPushButton;
class QToolButton;

namespace tessera {

// Hidden while there is nothing to say. The newest message replaces the one before; an error stays until it
// is closed or replaced, other messages without a question leave by themselves.
class MessageBar : public QFrame {
    Q_OBJECT

  public:
    explicit MessageBar(QWidget* parent = nullptr);

    void show(const Message& message);
    QString text() const;
    bool showsError() const { return mMessage.kind == Message::Kind::Error; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    Message mMessage;
    QLabel* mText;
    QPushButton* mAction;
    QToolButton* mClose;
    QTimer mLeave;
};

}  // namespace tessera
