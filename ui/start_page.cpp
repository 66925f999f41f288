// See start_page.h.
#include "ui/start_page.h"

#include <QDateTime>
#include <QDir>
#include <QDragEnterEvent>
#include <QFile>
#include <QFileInfo>
#include <QFutureWatcher>
#include <QGridLayout>
#include <QLabel>
#include <QMimeData>
#include <QPainter>
#include <QPainterPath>
#include <QPushButton>
#include <QStandardPaths>
#include <QVBoxLayout>
#include <QtConcurrent>
#include <algorithm>

#include "ui/conversions.h"
#include "ui/icons.h"
#include "ui/thumbnail.h"
#include "ui/widget_parts.h"

namespace tessera {

namespace {

constexpr QSize kThumbnailPx(152, 104);
constexpr int kPlaceholderPx = 36;
constexpr int kCardMarginPx = 8;
constexpr int kCardGapPx = 12;
constexpr int kMaxColumns = 5;
constexpr int kMarginPx = 32;
constexpr double kRoundingPx = 10;
const QString kSample = ":/sample/still_life.png";

QString thumbnailKey(const QString& path) {
    return path + '\n' + QFileInfo(path).lastModified().toString(Qt::ISODateWithMs);
}

}  // namespace

// A file of before: its picture over its name.
class RecentCard : public QAbstractButton {
  public:
    explicit RecentCard(QString file) : path(std::move(file)) {
        const QFileInfo info(path);
        setAccessibleName(info.fileName());
        setToolTip(QDir::toNativeSeparators(path));
        setFocusPolicy(Qt::StrongFocus);
        setCursor(Qt::PointingHandCursor);
        setAttribute(Qt::WA_Hover);
        setFixedSize(kThumbnailPx.width() + 2 * kCardMarginPx,
                     kThumbnailPx.height() + 3 * kCardMarginPx + fontMetrics().height());
    }

    void setThumbnail(const QImage& image) {
        mThumbnail = image;
        update();
    }

    const QString path;

  protected:
    void paintEvent(QPaintEvent*) override {
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
        const bool lit = underMouse() || hasFocus() || isDown();
        const QRectF frame = QRectF(rect()).adjusted(.5, .5, -.5, -.5);
        painter.setPen(lit ? palette().highlight().color() : palette().mid().color());
        painter.setBrush(palette().color(lit ? QPalette::AlternateBase : QPalette::Base));
        painter.drawRoundedRect(frame, kRoundingPx / 2, kRoundingPx / 2);
        const QRect picture(QPoint(kCardMarginPx, kCardMarginPx), kThumbnailPx);
        if (mThumbnail.isNull())
            tessera::icon("picture", palette())
                .paint(&painter, placeholderRect(picture), Qt::AlignCenter, QIcon::Disabled);
        else
            painter.drawImage(pictureRect(picture), mThumbnail);
        painter.setPen(palette().color(QPalette::WindowText));
        const QRect text(kCardMarginPx, picture.bottom() + kCardMarginPx, kThumbnailPx.width(),
                         fontMetrics().height());
        painter.drawText(text, Qt::AlignCenter,
                         fontMetrics().elidedText(QFileInfo(path).fileName(), Qt::ElideMiddle, text.width()));
    }

  private:
    static QRect placeholderRect(const QRect& room) {
        QRect rect(0, 0, kPlaceholderPx, kPlaceholderPx);
        rect.moveCenter(room.center());
        return rect;
    }

    // The thumbnail in the middle of the room for it, never enlarged.
    QRect pictureRect(const QRect& room) const {
        QSize size = mThumbnail.deviceIndependentSize().toSize();
        if (size.width() > room.width() || size.height() > room.height())
            size.scale(room.size(), Qt::KeepAspectRatio);
        QRect rect({}, size);
        rect.moveCenter(room.center());
        return rect;
    }

    QImage mThumbnail;
};

StartPage::StartPage(QWidget* parent) : QWidget(parent) {
    setAcceptDrops(true);
    mPool.setMaxThreadCount(1);
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(kMarginPx, kMarginPx, kMarginPx, kMarginPx);
    column->setSpacing(28);
    column->addStretch(1);
    column->addWidget(mDropArea = makeDropArea(), 0, Qt::AlignHCenter);
    column->addWidget(mRecent = makeRecentPart(), 0, Qt::AlignHCenter);
    column->addStretch(2);
    mRecent->hide();
    tintIcons();
}

StartPage::~StartPage() {
    mPool.clear();
}

QWidget* StartPage::makeDropArea() {
    auto* area = new QWidget;
    area->setObjectName("dropArea");
    auto* column = new QVBoxLayout(area);
    column->setContentsMargins(48, 32, 48, 32);
    column->setSpacing(12);
    auto* logo = new QLabel;
    logo->setPixmap(windowIcon().pixmap(72, 72));
    auto* title = new QLabel(tr("Drop a photo here"));
    QFont large = title->font();
    large.setPointSizeF(large.pointSizeF() * 1.7);
    title->setFont(large);
    auto* hint = dimLabel(tr("Tessera turns it into curved patches that stay sharp at any size."));
    hint->setWordWrap(false);
    for (QLabel* label : {logo, title, hint}) {
        label->setAlignment(Qt::AlignCenter);
        column->addWidget(label);
    }
    column->addSpacing(10);
    auto* row = new QHBoxLayout;
    row->setSpacing(10);
    row->addStretch(1);
    const auto add = [&](const char* name, const char* iconName, const QString& text, const QString& tip,
                         auto signal) {
        auto* button = new QPushButton(text);
        button->setObjectName(name);
        button->setToolTip(tip);
        button->setMinimumHeight(36);
        button->setFocusPolicy(Qt::StrongFocus);
        mIcons.insert(button, iconName);
        connect(button, &QPushButton::clicked, this, signal);
        row->addWidget(button);
        return button;
    };
    add("open", "open", tr("Open…"), tr("Open a photo or a Tessera document"),
        &StartPage::openDialogRequested)
        ->setProperty("role", "primary");
    add("paste", "paste", tr("Paste"), tr("Start from the picture in the clipboard"),
        &StartPage::pasteRequested);
    add("sample", "picture", tr("Try the Sample"), tr("Open a still life to try things on"),
        &StartPage::sampleRequested);
    row->addStretch(1);
    column->addLayout(row);
    return area;
}

QWidget* StartPage::makeRecentPart() {
    auto* part = new QWidget;
    auto* column = new QVBoxLayout(part);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(10);
    auto* clear = new QPushButton(tr("Clear"));
    clear->setObjectName("clearRecent");
    clear->setProperty("role", "small");
    clear->setToolTip(tr("Forget these files; they stay where they are"));
    connect(clear, &QPushButton::clicked, this, &StartPage::clearRecentRequested);
    auto* top = new QHBoxLayout;
    top->addWidget(headingLabel(tr("Recent")));
    top->addStretch(1);
    top->addWidget(clear);
    column->addLayout(top);
    mGrid = new QGridLayout;
    mGrid->setSpacing(kCardGapPx);
    column->addLayout(mGrid);
    return part;
}

// Icons are in the theme's colours, so they are made again when it changes.
void StartPage::tintIcons() {
    for (auto entry = mIcons.begin(); entry != mIcons.end(); ++entry) {
        QPalette tint = palette();
        if (entry.key()->property("role") == "primary")
            tint.setColor(QPalette::ButtonText, tint.color(QPalette::HighlightedText));
        entry.key()->setIcon(icon(entry.value(), tint));
    }
}

void StartPage::setRecentFiles(const QStringList& paths) {
    qDeleteAll(mCards);
    mCards.clear();
    mPool.clear();
    mLoading = 0;
    for (const QString& path : paths) {
        auto* card = new RecentCard(path);
        connect(card, &QAbstractButton::clicked, this, [this, path] { emit openRequested(path); });
        mCards.append(card);
        loadThumbnail(card);
    }
    mRecent->setVisible(!mCards.isEmpty());
    mColumns = 0;
    arrangeCards();
}

void StartPage::loadThumbnail(RecentCard* card) {
    const QString key = thumbnailKey(card->path);
    if (const auto known = mThumbnails.constFind(key); known != mThumbnails.constEnd())
        return card->setThumbnail(*known);
    ++mLoading;
    const QSize pixels = kThumbnailPx * devicePixelRatioF();
    // Goes with the card: what is ready after that is dropped.
    auto* watcher = new QFutureWatcher<QImage>(card);
    connect(watcher, &QFutureWatcherBase::finished, card,
            [this, card, watcher, key, ratio = devicePixelRatioF()] {
                QImage image = watcher->result();
                image.setDevicePixelRatio(ratio);
                --mLoading;
                mThumbnails.insert(key, image);
                card->setThumbnail(image);
            });
    watcher->setFuture(QtConcurrent::run(&mPool, thumbnailOf, card->path, pixels));
}

void StartPage::arrangeCards() {
    const int cardWidth = kThumbnailPx.width() + 2 * kCardMarginPx + kCardGapPx;
    const int columns = std::clamp((width() - 2 * kMarginPx + kCardGapPx) / cardWidth, 1, kMaxColumns);
    if (columns == mColumns) return;
    mColumns = columns;
    for (int i = 0; i < mCards.size(); ++i)
        mGrid->addWidget(mCards[i], i / columns, i % columns, Qt::AlignLeft);
}

void StartPage::setDragging(bool dragging) {
    mDragging = dragging;
    update();
}

void StartPage::dragEnterEvent(QDragEnterEvent* event) {
    if (localFiles(event->mimeData()).isEmpty()) return;
    event->acceptProposedAction();
    setDragging(true);
}

void StartPage::dragLeaveEvent(QDragLeaveEvent*) {
    setDragging(false);
}

void StartPage::dropEvent(QDropEvent* event) {
    setDragging(false);
    const QStringList files = localFiles(event->mimeData());
    if (files.isEmpty()) return;
    event->acceptProposedAction();
    for (const QString& file : files) emit openRequested(file);
}

void StartPage::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), palette().window());
    painter.setRenderHint(QPainter::Antialiasing);
    const QColor line = palette().color(mDragging ? QPalette::Highlight : QPalette::PlaceholderText);
    painter.setPen(QPen(line, mDragging ? 2 : 1.25, Qt::DashLine, Qt::RoundCap));
    if (mDragging) {
        QColor wash = line;
        wash.setAlpha(28);
        painter.setBrush(wash);
    }
    painter.drawRoundedRect(QRectF(mDropArea->geometry()).adjusted(1, 1, -1, -1), kRoundingPx, kRoundingPx);
}

void StartPage::resizeEvent(QResizeEvent*) {
    arrangeCards();
}

void StartPage::changeEvent(QEvent* event) {
    QWidget::changeEvent(event);
    if (event->type() == QEvent::PaletteChange) tintIcons();
}

QString StartPage::sampleFile() {
    const QDir folder(QStandardPaths::writableLocation(QStandardPaths::CacheLocation));
    const QString path = folder.filePath(QFileInfo(kSample).fileName());
    if (QFileInfo(path).size() == QFileInfo(kSample).size()) return path;
    QFile::remove(path);
    if (!folder.mkpath(".") || !QFile::copy(kSample, path)) return {};
    QFile::setPermissions(path, QFile::ReadOwner | QFile::WriteOwner);
    return path;
}

}  // namespace tessera
