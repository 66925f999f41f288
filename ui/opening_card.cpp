// See opening_card.h.
#include "ui/opening_card.h"

#include <QLabel>
#include <QPainter>
#include <QProgressBar>
#include <QPushButton>
#include <QVBoxLayout>
#include <cmath>

#include "app/jobs/job.h"
#include "ui/widget_parts.h"

namespace tessera {

namespace {

constexpr int kWidthPx = 340;
constexpr int kMarginPx = 20;
constexpr double kRoundingPx = 8;
constexpr int kPercent = 100;

}  // namespace

OpeningCard::OpeningCard(QWidget* parent)
    : QWidget(parent),
      mText(new QLabel),
      mProgress(new QProgressBar),
      mCancel(new QPushButton(tr("Cancel"))) {
    setFixedWidth(kWidthPx);
    auto* column = partColumn(this);
    column->setContentsMargins(kMarginPx, kMarginPx, kMarginPx, kMarginPx);
    column->setSpacing(14);
    mText->setAlignment(Qt::AlignCenter);
    mText->setTextFormat(Qt::PlainText);
    mText->setWordWrap(true);
    mProgress->setRange(0, kPercent);
    mProgress->setTextVisible(false);
    mProgress->setAccessibleName(tr("How much of the file has been opened"));
    mCancel->setObjectName("cancelOpening");
    mCancel->setToolTip(tr("Leave the file as it is, and open another one"));
    column->addWidget(mText);
    column->addWidget(mProgress);
    column->addWidget(mCancel, 0, Qt::AlignHCenter);
    connect(mCancel, &QPushButton::clicked, this, &OpeningCard::cancelRequested);
    hide();
}

void OpeningCard::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(palette().dark().color());
    painter.setBrush(palette().window());
    painter.drawRoundedRect(QRectF(rect()).adjusted(.5, .5, -.5, -.5), kRoundingPx, kRoundingPx);
}

void OpeningCard::showJob(const Job* job) {
    setVisible(job);
    if (!job) return;
    mText->setText(job->stopRequested() ? job->title() + tr(" — stopping…") : job->title() + "…");
    mProgress->setValue(int(std::lround(kPercent * job->fraction())));
    mCancel->setEnabled(!job->stopRequested());
}

}  // namespace tessera
