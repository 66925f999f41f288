// One sentence across the top of the canvas: what went wrong or well, never in the way.
#pragma once

#include <QFrame>
#include <QTimer>
#include <deque>
#include <optional>

#include "app/message.h"

class QLabel;
class QPushButton;
class QToolButton;

namespace tessera {

// Hidden while there is nothing to say. The newest message replaces the one before; an error stays until it
// is closed or replaced, other messages without a question leave by themselves. Questions that are kept wait
// behind them, in the order in which they came, each as long as its document is in front.
class MessageBar : public QFrame {
    Q_OBJECT

  public:
    explicit MessageBar(QWidget* parent = nullptr);

    void show(const Message& message);
    // What is no kept question goes.
    void clear();
    // Another document is in front, or none: the messages so far were not about it.
    void setDocument(const DocumentSession* document);
    // Its questions have become pointless.
    void forget(const DocumentSession* document);

    QString text() const;
    bool showsError() const;

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    // The message to be seen; null for none.
    const Message* front() const;
    // Removes that message and returns it.
    Message take();
    void showFront();

    std::optional<Message> mPassing;
    std::deque<Message> mKept;
    const DocumentSession* mDocument = nullptr;
    QLabel* mText;
    QPushButton* mAction;
    QToolButton* mClose;
    QTimer mLeave;
};

}  // namespace tessera
