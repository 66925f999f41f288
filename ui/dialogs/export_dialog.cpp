// See export_dialog.h.
#include "ui/dialogs/export_dialog.h"

#include <QColorDialog>
#include <QColorSpace>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "ui/dialogs/dialog_parts.h"
#include "ui/icons.h"
#include "ui/status_bar.h"
#include "ui/widget_parts.h"

namespace tessera {

namespace {

struct FormatSpec {
    PictureFormat format;
    const char* name;
    const char* suffix;
    const char* patterns;
    bool depth;         // 8 or 16 bits can be chosen
    bool quality;       // of JPEG
    bool transparency;  // can be kept
    bool profile;
    int maxSidePx;
};

constexpr int kNoLimitPx = 1'000'000;
// The JPEG libraries' own limit.
constexpr int kJpegLimitPx = 65'500;

const FormatSpec kFormats[] = {
    {PictureFormat::Png, "PNG", "png", "*.png", true, false, true, true, kNoLimitPx},
    {PictureFormat::Jpeg, "JPEG", "jpg", "*.jpg *.jpeg", false, true, false, true, kJpegLimitPx},
    {PictureFormat::Tiff, "TIFF", "tif", "*.tif *.tiff", true, false, true, true, kNoLimitPx},
    {PictureFormat::Exr, "OpenEXR", "exr", "*.exr", false, false, true, false, kNoLimitPx},
};

// From here on, one is told what the picture takes.
constexpr double kLargePixels = 50e6;
// Four floats while it is drawn, and as much again at most while it is written.
constexpr double kBytesPerPixel = 32;
constexpr const char* kBlob = "export";
constexpr QSize kSwatchPx(28, 14);

enum Profile { Srgb, PhotoProfile, NoProfile };
enum Background { Transparent, Colour };

const FormatSpec& chosen(const QComboBox* box) {
    return kFormats[size_t(std::max(0, box->currentIndex()))];
}

QSpinBox* pixelField() {
    auto* field = new QSpinBox;
    field->setRange(1, kNoLimitPx);
    field->setSuffix(ExportDialog::tr(" px"));
    field->setGroupSeparatorShown(true);
    field->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
    return field;
}

// How a person knows the profile: by the name in it.
QString profileName(const std::vector<uint8_t>& icc) {
    if (icc.empty()) return {};
    const QByteArray bytes(reinterpret_cast<const char*>(icc.data()), qsizetype(icc.size()));
    return QColorSpace::fromIccProfile(bytes).description();
}

void choose(QComboBox* box, const QJsonValue& data) {
    const int index = box->findData(data.toVariant());
    if (index >= 0) box->setCurrentIndex(index);
}

}  // namespace

ExportDialog::ExportDialog(QSize picture, std::vector<uint8_t> photoProfile, Settings& settings,
                           QWidget* parent)
    : QDialog(parent), mPicture(picture), mPhotoProfile(std::move(photoProfile)), mSettings(settings) {
    setWindowTitle(tr("Export Picture"));
    makeFields(profileName(mPhotoProfile));
    makeLayout();
    restore();
    connectFields();
    scaleChanged();
    mScale->setFocus();
    mScale->selectAll();
}

void ExportDialog::makeFields(const QString& profile) {
    mFormat = new QComboBox;
    for (const FormatSpec& spec : kFormats) mFormat->addItem(spec.name, spec.suffix);
    mScale = new QDoubleSpinBox;
    mScale->setRange(.1, 100'000);
    mScale->setDecimals(1);
    mScale->setValue(100);
    mScale->setSuffix(tr(" %"));
    mScale->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
    mWidth = pixelField();
    mHeight = pixelField();
    mLinked = new QToolButton;
    mLinked->setIcon(icon("lock", palette()));
    mLinked->setCheckable(true);
    mLinked->setChecked(true);
    mLinked->setAutoRaise(true);
    mSize = dimLabel({});
    mSamples = new QComboBox;
    mSamples->addItem(tr("None: one sample a pixel"), 1);
    mSamples->addItem(tr("Smooth: 4 samples"), 4);
    mSamples->addItem(tr("Finest: 16 samples"), 16);
    choose(mSamples, kPictureSamples);
    mDepth = new QComboBox;
    mDepth->addItem(tr("8 bits a channel"), 8);
    mDepth->addItem(tr("16 bits a channel"), 16);
    mQuality = new QSpinBox;
    mQuality->setRange(1, 100);
    mQuality->setValue(WriteOptions{}.jpegQuality);
    mProfile = new QComboBox;
    mProfile->addItem(tr("sRGB"), Srgb);
    if (!mPhotoProfile.empty())
        mProfile->addItem(profile.isEmpty() ? tr("The photo's") : tr("The photo's: %1").arg(profile),
                          PhotoProfile);
    mProfile->addItem(tr("sRGB, not embedded"), NoProfile);
    mBackground = new QComboBox;
    mBackground->addItem(tr("Transparent"), Transparent);
    mBackground->addItem(tr("Colour"), Colour);
    mSwatch = new QPushButton;
    mSwatch->setProperty("role", "small");
    mSwatch->setIconSize(kSwatchPx);
    mSwatch->setAutoDefault(false);  // the Enter key exports
    mButtons = new QDialogButtonBox(QDialogButtonBox::Cancel);
    mExport = addPrimaryButton(mButtons, tr("Export…"));

    const std::pair<QWidget*, const char*> names[] = {
        {mFormat, "format"},   {mScale, "scale"},     {mWidth, "width"},           {mHeight, "height"},
        {mLinked, "linked"},   {mSize, "size"},       {mSamples, "samples"},       {mDepth, "depth"},
        {mQuality, "quality"}, {mProfile, "profile"}, {mBackground, "background"}, {mSwatch, "swatch"}};
    for (const auto& [field, name] : names) field->setObjectName(name);
}

QLayout* ExportDialog::makeSizeRow() {
    auto* row = new QHBoxLayout;
    row->setSpacing(6);
    row->addWidget(mWidth, 1);
    row->addWidget(new QLabel("×"));
    row->addWidget(mHeight, 1);
    row->addWidget(mLinked);
    mHeight->setAccessibleName(tr("Height"));
    mLinked->setAccessibleName(tr("Keep proportions"));
    mLinked->setToolTip(tr("Keep the proportions of the picture"));
    return row;
}

void ExportDialog::makeLayout() {
    auto* background = new QHBoxLayout;
    background->setSpacing(6);
    background->addWidget(mBackground, 1);
    background->addWidget(mSwatch);
    mSwatch->setAccessibleName(tr("Background colour"));
    mSwatch->setToolTip(tr("Choose the colour behind what is transparent"));

    QFormLayout* form = dialogForm();
    addField(form, tr("&Format"), mFormat);
    addField(form, tr("&Scale"), mScale);
    addField(form, tr("&Width × height"), makeSizeRow(), mWidth);
    mWidth->setAccessibleName(tr("Width"));
    form->addRow({}, mSize);
    addField(form, tr("&Anti-aliasing"), mSamples);
    addField(form, tr("&Depth"), mDepth);
    addField(form, tr("&Quality"), mQuality);
    addField(form, tr("&Profile"), mProfile);
    addField(form, tr("&Background"), background, mBackground);
    QVBoxLayout* column = dialogColumn(this);
    column->addLayout(form);
    column->addStretch(1);
    column->addWidget(mButtons);
    setMinimumWidth(430);
}

void ExportDialog::connectFields() {
    connect(mButtons, &QDialogButtonBox::accepted, this, &ExportDialog::accept);
    connect(mButtons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(mScale, &QDoubleSpinBox::valueChanged, this, &ExportDialog::scaleChanged);
    connect(mWidth, &QSpinBox::valueChanged, this, [this] { sideChanged(mWidth, mHeight); });
    connect(mHeight, &QSpinBox::valueChanged, this, [this] { sideChanged(mHeight, mWidth); });
    connect(mLinked, &QToolButton::toggled, this, [this](bool linked) {
        mLinked->setIcon(icon(linked ? "lock" : "unlock", palette()));
        if (linked) sideChanged(mWidth, mHeight);
    });
    for (const QComboBox* box : {mFormat, mDepth, mBackground})
        connect(box, &QComboBox::currentIndexChanged, this, &ExportDialog::update);
    connect(mSwatch, &QPushButton::clicked, this, &ExportDialog::chooseColour);
}

void ExportDialog::restore() {
    const QJsonObject last = QJsonDocument::fromJson(mSettings.blob(kBlob)).object();
    choose(mFormat, last["format"]);
    choose(mSamples, last["samples"]);
    choose(mDepth, last["depth"]);
    choose(mProfile, last["profile"]);
    choose(mBackground, last["background"]);
    mScale->setValue(last["scale"].toDouble(mScale->value()));
    mQuality->setValue(last["quality"].toInt(mQuality->value()));
    const QColor colour(last["colour"].toString());
    setColour(colour.isValid() ? colour : mColour);
}

void ExportDialog::store() const {
    mSettings.setBlob(kBlob, QJsonDocument(QJsonObject{{"format", mFormat->currentData().toString()},
                                                       {"scale", mScale->value()},
                                                       {"samples", mSamples->currentData().toInt()},
                                                       {"depth", mDepth->currentData().toInt()},
                                                       {"quality", mQuality->value()},
                                                       {"profile", mProfile->currentData().toInt()},
                                                       {"background", mBackground->currentData().toInt()},
                                                       {"colour", mColour.name()}})
                                 .toJson(QJsonDocument::Compact));
}

void ExportDialog::accept() {
    store();
    QDialog::accept();
}

void ExportDialog::scaleChanged() {
    const QSize scaled = exportSize(mPicture, {.path = {}, .scale = mScale->value() / 100});
    const QSignalBlocker width(mWidth), height(mHeight);
    mWidth->setValue(scaled.width());
    mHeight->setValue(scaled.height());
    update();
}

void ExportDialog::sideChanged(QSpinBox* changed, QSpinBox* other) {
    const bool isWidth = changed == mWidth;
    const double scale = double(changed->value()) / (isWidth ? mPicture.width() : mPicture.height());
    if (mLinked->isChecked()) {
        const QSignalBlocker blocker(other);
        other->setValue(int(std::round(scale * (isWidth ? mPicture.height() : mPicture.width()))));
    }
    if (mLinked->isChecked() || isWidth) {
        const QSignalBlocker blocker(mScale);
        mScale->setValue(100 * scale);
    }
    update();
}

void ExportDialog::chooseColour() {
    const QColor colour = QColorDialog::getColor(mColour, this, tr("Background Colour"));
    if (colour.isValid()) setColour(colour);
}

void ExportDialog::setColour(const QColor& colour) {
    mColour = colour;
    QPixmap swatch(kSwatchPx);
    swatch.fill(colour);
    mSwatch->setIcon(swatch);
}

QSize ExportDialog::size() const {
    return {mWidth->value(), mHeight->value()};
}

bool ExportDialog::hasBackground() const {
    return !chosen(mFormat).transparency || mBackground->currentData().toInt() == Colour;
}

QString ExportDialog::sizeProblem() const {
    const FormatSpec& spec = chosen(mFormat);
    const double pixels = double(size().width()) * size().height();
    if (pixels > kMaxExportPixels)
        return tr("Too large: at most %1 megapixels can be exported.").arg(kMaxExportPixels / 1e6);
    if (std::max(size().width(), size().height()) > spec.maxSidePx)
        return tr("Too large: a %1 has at most %2 pixels a side.")
            .arg(spec.name, countText(size_t(spec.maxSidePx)));
    return {};
}

QString ExportDialog::sizeWarning() const {
    const double pixels = double(size().width()) * size().height();
    if (pixels < kLargePixels) return {};
    return tr("A huge picture: it may take minutes and %1 of memory.")
        .arg(QLocale().formattedDataSize(qint64(pixels * kBytesPerPixel), 1));
}

void ExportDialog::update() {
    const FormatSpec& spec = chosen(mFormat);
    mDepth->setEnabled(spec.depth);
    mQuality->setEnabled(spec.quality);
    mProfile->setEnabled(spec.profile);
    mBackground->setEnabled(spec.transparency);
    mSwatch->setEnabled(hasBackground());
    const QString problem = sizeProblem();
    QStringList lines = {
        tr("%1 × %2 pixels, %3 megapixels")
            .arg(countText(size_t(size().width())), countText(size_t(size().height())),
                 QLocale().toString(double(size().width()) * size().height() / 1e6, 'f', 1))};
    if (spec.format == PictureFormat::Exr) lines << tr("Linear light, half floats.");
    const QString remark = problem.isEmpty() ? sizeWarning() : problem;
    if (!remark.isEmpty()) lines << remark;
    mSize->setText(lines.join('\n'));
    mExport->setEnabled(problem.isEmpty());
}

ExportRequest ExportDialog::request() const {
    const FormatSpec& spec = chosen(mFormat);
    ExportRequest request{.path = {},
                          .scale = mScale->value() / 100,
                          .size = size(),
                          .samples = mSamples->currentData().toInt()};
    request.options.bitsPerChannel = spec.depth ? mDepth->currentData().toInt() : 8;
    request.options.jpegQuality = mQuality->value();
    if (hasBackground()) request.options.background = {{mColour.redF(), mColour.greenF(), mColour.blueF()}};
    const int profile = mProfile->currentData().toInt();
    request.options.embedProfile = profile != NoProfile;
    if (profile == PhotoProfile) request.options.iccProfile = mPhotoProfile;
    return request;
}

QString ExportDialog::suffix() const {
    return chosen(mFormat).suffix;
}

QString ExportDialog::filter() const {
    return QString("%1 (%2)").arg(chosen(mFormat).name, chosen(mFormat).patterns);
}

}  // namespace tessera
