// See message_bar.h.
#include "ui/message_bar.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QToolButton>
#include <algorithm>

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
    connect(&mLeave, &QTimer::timeout, this, &MessageBar::clear);
    connect(mClose, &QToolButton::clicked, this, &MessageBar::take);
    connect(mAction, &QPushButton::clicked, this, [this] { take().action(); });
    hide();
}

void MessageBar::show(const Message& message) {
    if (message.keep)
        mKept.push_back(message);
    else
        mPassing = message;
    showFront();
}

void MessageBar::clear() {
    mPassing.reset();
    showFront();
}

void MessageBar::setDocument(const DocumentSession* document) {
    mDocument = document;
    clear();
}

void MessageBar::forget(const DocumentSession* document) {
    std::erase_if(mKept, [&](const Message& message) { return message.about == document; });
    showFront();
}

const Message* MessageBar::front() const {
    if (mPassing) return &*mPassing;
    const auto kept = std::find_if(mKept.begin(), mKept.end(), [&](const Message& message) {
        return !message.about || message.about == mDocument;
    });
    return kept == mKept.end() ? nullptr : &*kept;
}

Message MessageBar::take() {
    const Message* const seen = front();
    if (!seen) return {};
    const Message taken = *seen;
    if (mPassing)
        mPassing.reset();
    else
        mKept.erase(std::find_if(mKept.begin(), mKept.end(), [&](const Message& m) { return &m == seen; }));
    showFront();
    return taken;
}

void MessageBar::showFront() {
    mLeave.stop();
    const Message* const message = front();
    setVisible(message);
    if (!message) return;
    mText->setText(message->text);
    mAction->setText(message->actionText);
    mAction->setVisible(bool(message->action));
    if (message->kind == Message::Kind::Info && !message->action) mLeave.start(kShownMs);
    update();
}

bool MessageBar::showsError() const {
    return front() && front()->kind == Message::Kind::Error;
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
