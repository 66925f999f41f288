// See message_bar.h.
#include "ui/message_bar.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QToolButton>

namespace tessera {

namespace {

constexpr int kShownMs = 6000;
constexpr int kStripePx = 4;
const QColor kErrorColour(224, 82, 74);
const QColor kInfoColour(61, 139, 217);

}  // namespace

MessageBar::MessageBar(QWidget* parent)
    : QFrame(parent), mText(new QLabel), mAction(new QPushButton), mClose(new QToolButton) {
    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(16, 8, 8, 8);
    layout->setSpacing(12);
    mText->setWordWrap(true);
    mText->setTextFormat(Qt::PlainText);
    mText->setTextInteractionFlags(Qt::TextSelectableByMouse);
    layout->addWidget(mText, 1);
    layout->addWidget(mAction);
    mClose->setText("✕");
    mClose->setAutoRaise(true);
    mClose->setToolTip(tr("Close"));
    layout->addWidget(mClose);
    mLeave.setSingleShot(true);
    connect(&mLeave, &QTimer::timeout, this, &QWidget::hide);
    connect(mClose, &QToolButton::clicked, this, &QWidget::hide);
    connect(mAction, &QPushButton::clicked, this, [this] {
        hide();
        if (mMessage.action) mMessage.action();
    });
    hide();
}

void MessageBar::show(const Message& message) {
    mMessage = message;
    mText->setText(message.text);
    mAction->setText(message.actionText);
    mAction->setVisible(bool(message.action));
    if (message.kind == Message::Kind::Info && !message.action)
        mLeave.start(kShownMs);
    else
        mLeave.stop();
    QFrame::show();
    update();
}

QString MessageBar::text() const {
    return isVisible() ? mText->text() : QString();
}

void MessageBar::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const QColor colour = showsError() ? kErrorColour : kInfoColour;
    QColor tint = colour;
    tint.setAlpha(46);
    painter.fillRect(rect(), palette().window());
    painter.fillRect(rect(), tint);
    painter.fillRect(QRect(0, 0, kStripePx, height()), colour);
}

}  // namespace tessera
