// See status_bar.h.
#include "ui/status_bar.h"

#include <QHBoxLayout>
#include <QHash>
#include <QLabel>
#include <QLocale>
#include <QMenu>
#include <QPainter>
#include <QProgressBar>
#include <QPushButton>
#include <algorithm>
#include <cmath>

#include "app/document_session.h"

namespace tessera {

namespace {

constexpr int kProgressSteps = 1000;
constexpr int kAgainMs = 1000;
constexpr int kHeightPx = 32;
constexpr int kLeastTextPx = 60;

// One line that is cut where there is no room for it: a job with a long name must not widen the window.
class ElidedLabel : public QLabel {
  public:
    QSize minimumSizeHint() const override {
        return {std::min(kLeastTextPx, sizeHint().width()), QLabel::minimumSizeHint().height()};
    }

  protected:
    void paintEvent(QPaintEvent*) override {
        QPainter painter(this);
        painter.drawText(rect(), Qt::AlignLeft | Qt::AlignVCenter,
                         fontMetrics().elidedText(text(), Qt::ElideRight, width()));
    }
};

// A label as wide as the longest text that it will show, so that the line does not shiver while the mouse
// moves.
QLabel* fixedLabel(const QString& widest, Qt::Alignment alignment) {
    auto* label = new QLabel;
    label->setMinimumWidth(label->fontMetrics().horizontalAdvance(widest) + 4);
    label->setAlignment(alignment | Qt::AlignVCenter);
    return label;
}

// No finer than an estimate is.
QString leftText(double seconds) {
    constexpr int kStep = 5, kMinute = 60;
    if (seconds < 2 * kStep) return QObject::tr("a few seconds left");
    if (seconds < 1.5 * kMinute)
        return QObject::tr("about %1 s left").arg(kStep * int(std::lround(seconds / kStep)));
    return QObject::tr("about %1 min left").arg(int(std::lround(seconds / kMinute)));
}

// How many patches are not as any other, each kind named where there are some.
QString statesText(const PatchMarks& marks) {
    QString text;
    for (const auto& [patches, words] : {std::pair(&marks.hidden(), StatusBar::tr("%1 hidden")),
                                         std::pair(&marks.locked(), StatusBar::tr("%1 locked")),
                                         std::pair(&marks.cutOut(), StatusBar::tr("%1 cut out"))})
        if (!patches->empty()) text += words.arg(countText(patches->size())) + "  ·  ";
    return text;
}

}  // namespace

QString countText(size_t count) {
    return QLocale().toString(qulonglong(count));
}

QString stageText(const QString& stage) {
    static const QHash<QString, const char*> kWords{
        {"features", QT_TRANSLATE_NOOP("QObject", "finding outlines")},
        {"initial-mesh", QT_TRANSLATE_NOOP("QObject", "laying out patches")},
        {"simplify", QT_TRANSLATE_NOOP("QObject", "choosing patches")},
        {"curves", QT_TRANSLATE_NOOP("QObject", "bending curves")},
        {"colours", QT_TRANSLATE_NOOP("QObject", "fitting colours")},
        {"vectorize", QT_TRANSLATE_NOOP("QObject", "trying a number of patches")},
        {"draft", QT_TRANSLATE_NOOP("QObject", "trying a draft")},
        {"reading", QT_TRANSLATE_NOOP("QObject", "reading")},
        {"drawing", QT_TRANSLATE_NOOP("QObject", "drawing")},
        {"drawing the preview", QT_TRANSLATE_NOOP("QObject", "drawing the preview")},
        {"measuring", QT_TRANSLATE_NOOP("QObject", "measuring")},
        {"writing", QT_TRANSLATE_NOOP("QObject", "writing")},
    };
    const char* words = kWords.value(stage, nullptr);
    return words ? QObject::tr(words) : QString();
}

QString zoomText(double scale) {
    const double percent = scale * 100;
    const int digits = percent >= 100 || std::abs(percent - std::round(percent)) < .05 ? 0 : 1;
    return QLocale().toString(percent, 'f', digits) + " %";
}

StatusBar::StatusBar(QWidget* parent) : QStatusBar(parent) {
    setSizeGripEnabled(false);
    // Always the same, so that the canvas does not jump when a job comes or goes.
    setFixedHeight(kHeightPx);
    mJob = new QWidget;
    auto* jobLayout = new QHBoxLayout(mJob);
    jobLayout->setContentsMargins(12, 3, 0, 3);
    jobLayout->setSpacing(10);
    mJobText = new ElidedLabel;
    mProgress = new QProgressBar;
    mProgress->setRange(0, kProgressSteps);
    mProgress->setTextVisible(false);
    mProgress->setFixedWidth(160);
    mCancel = new QPushButton(tr("Cancel"));
    mCancel->setProperty("role", "small");
    mCancel->setFocusPolicy(Qt::NoFocus);
    mCancel->setObjectName("cancelJob");
    jobLayout->addWidget(mProgress);
    jobLayout->addWidget(mCancel);
    jobLayout->addWidget(mJobText, 1);
    addWidget(mJob, 1);
    mJob->hide();
    connect(mCancel, &QPushButton::clicked, this, &StatusBar::cancelRequested);
    connect(&mAgain, &QTimer::timeout, this, [this] { showJob(mShown); });

    mSelected = new QLabel;
    mRenderer = new QLabel;
    mRenderer->setProperty("role", "dim");
    mCounts = new ElidedLabel;
    mCursor = fixedLabel("00000, 00000", Qt::AlignRight);
    mSwatch = new QLabel;
    mSwatch->setFixedSize(16, 16);
    mColour = fixedLabel("#DDDDDD", Qt::AlignLeft);
    mZoom = new QPushButton;
    mZoom->setFlat(true);
    mZoom->setProperty("role", "small");
    mZoom->setFocusPolicy(Qt::NoFocus);
    mZoom->setMinimumWidth(mZoom->fontMetrics().horizontalAdvance("100,000 %") + 24);
    mZoom->setToolTip(tr("How large the picture is shown; click for other sizes"));
    mZoom->setObjectName("zoom");
    mZoom->setMenu(new QMenu(mZoom));
    // In one widget: QStatusBar makes itself a new layout, with its own distances, whenever it likes.
    auto* figures = new QWidget;
    auto* row = new QHBoxLayout(figures);
    row->setContentsMargins(0, 0, 8, 0);
    row->setSpacing(12);
    for (QWidget* widget :
         std::initializer_list<QWidget*>{mSelected, mCounts, mCursor, mSwatch, mColour, mRenderer, mZoom})
        row->addWidget(widget);
    addPermanentWidget(figures);
}

void StatusBar::showJob(const Job* job) {
    mShown = job;
    mJob->setVisible(job);
    if (!job) return mAgain.stop();
    mAgain.start(kAgainMs);
    QString text = job->title();
    if (job->stopRequested())
        text += tr(" — stopping…");
    else if (const QString stage = stageText(job->stage()); !stage.isEmpty())
        text += tr(" — %1, %2 %").arg(stage).arg(int(std::floor(job->fraction() * 100)));
    if (const auto left = job->secondsLeft(); left && !job->stopRequested()) text += ", " + leftText(*left);
    mJobText->setText(text);
    mProgress->setValue(int(job->fraction() * kProgressSteps));
    mCancel->setVisible(job->kind() != JobKind::Save);
    mCancel->setEnabled(!job->stopRequested());
}

QMenu& StatusBar::zoomMenu() {
    return *mZoom->menu();
}

QString StatusBar::jobText() const {
    return mJob->isHidden() ? QString() : mJobText->text();
}

void StatusBar::showRenderer(bool graphicsCard, const QString& text) {
    mRenderer->setText(graphicsCard ? tr("GPU") : tr("CPU"));
    mRenderer->setToolTip(text);
}

void StatusBar::showSelection(size_t patches) {
    mSelected->setText(patches == 0 ? QString() : tr("%1 selected  ·").arg(countText(patches)));
}

void StatusBar::showZoom(std::optional<double> scale) {
    mZoom->setVisible(scale.has_value());
    mZoom->setText(scale ? zoomText(*scale) : QString());
}

void StatusBar::showCursor(std::optional<QPointF> image, QColor colour) {
    mCursor->setText(image ? QString("%1, %2").arg(std::floor(image->x())).arg(std::floor(image->y()))
                           : QString());
    mColour->setText(image && colour.isValid() ? colour.name().toUpper() : QString());
    mSwatch->setStyleSheet(
        image && colour.isValid()
            ? QString("background: %1; border: 1px solid #808080; border-radius: 3px;").arg(colour.name())
            : QString());
}

void StatusBar::showCounts(const DocumentSession* session, size_t features, std::optional<size_t> draft) {
    QString text;
    if (draft) {
        text = tr("Draft: %1 patches").arg(countText(*draft));
    } else if (session && session->hasMesh()) {
        text = statesText(session->marks()) +
               tr("%1 patches  ·  %2 feature curves")
                   .arg(countText(session->document().mesh.patchCount()), countText(features));
        if (const auto& difference = session->document().difference)
            text += tr("  ·  mean error %1").arg(QLocale().toString(difference->mae, 'f', 2));
        else if (session->document().fitted)
            text += tr("  ·  edited");
    } else if (session) {
        text = tr("Photo, %1 × %2").arg(session->width()).arg(session->height());
    }
    mCounts->setText(text);
    mCounts->setToolTip(tr(
        "The mean error is in levels of 255, of the vector image at 100 % against the photo; of one that has "
        "been edited the heat map says more"));
}

}  // namespace tessera
