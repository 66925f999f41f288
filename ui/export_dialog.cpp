// See export_dialog.h.
#include "ui/export_dialog.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "ui/status_bar.h"

namespace tessera {

namespace {

struct FormatSpec {
    PictureFormat format;
    const char* name;
    const char* suffix;
    const char* patterns;
    bool depth;    // 8 or 16 bits can be chosen
    bool quality;  // of JPEG
};

const FormatSpec kFormats[] = {
    {PictureFormat::Png, "PNG", "png", "*.png", true, false},
    {PictureFormat::Jpeg, "JPEG", "jpg", "*.jpg *.jpeg", false, true},
    {PictureFormat::Tiff, "TIFF", "tif", "*.tif *.tiff", true, false},
    {PictureFormat::Exr, "OpenEXR (linear, half float)", "exr", "*.exr", false, false},
};

const FormatSpec& chosen(const QComboBox* box) {
    return kFormats[size_t(std::max(0, box->currentIndex()))];
}

}  // namespace

ExportDialog::ExportDialog(QSize picture, QWidget* parent)
    : QDialog(parent),
      mPicture(picture),
      mFormat(new QComboBox),
      mScale(new QDoubleSpinBox),
      mSize(new QLabel),
      mDepth(new QComboBox),
      mQuality(new QSpinBox),
      mButtons(new QDialogButtonBox(QDialogButtonBox::Cancel)) {
    setWindowTitle(tr("Export Picture"));
    for (const FormatSpec& spec : kFormats) mFormat->addItem(spec.name);
    mScale->setRange(1, 6400);
    mScale->setDecimals(1);
    mScale->setValue(100);
    mScale->setSuffix(" %");
    mScale->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
    mDepth->addItem(tr("8 bits a channel"), 8);
    mDepth->addItem(tr("16 bits a channel"), 16);
    mQuality->setRange(1, 100);
    mQuality->setValue(95);
    mSize->setProperty("role", "dim");
    mSize->setMinimumWidth(260);

    auto* form = new QFormLayout;
    form->setHorizontalSpacing(16);
    form->setVerticalSpacing(10);
    form->addRow(tr("&Format"), mFormat);
    form->addRow(tr("&Scale"), mScale);
    form->addRow({}, mSize);
    form->addRow(tr("&Depth"), mDepth);
    form->addRow(tr("&Quality"), mQuality);
    auto* exportButton = mButtons->addButton(tr("Export…"), QDialogButtonBox::AcceptRole);
    exportButton->setProperty("role", "primary");
    exportButton->setDefault(true);
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(20, 20, 20, 16);
    column->setSpacing(20);
    column->addLayout(form);
    column->addWidget(mButtons);

    connect(mButtons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(mButtons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(mFormat, &QComboBox::currentIndexChanged, this, [this] { update(); });
    connect(mScale, &QDoubleSpinBox::valueChanged, this, [this] { update(); });
    update();
    mScale->setFocus();
    mScale->selectAll();
}

void ExportDialog::update() {
    const FormatSpec& spec = chosen(mFormat);
    mDepth->setEnabled(spec.depth);
    mQuality->setEnabled(spec.quality);
    const double scale = mScale->value() / 100;
    const double width = std::max(1.0, std::round(mPicture.width() * scale));
    const double height = std::max(1.0, std::round(mPicture.height() * scale));
    const bool fits = width * height <= kMaxExportPixels;
    mSize->setText(fits ? tr("%1 × %2 pixels").arg(countText(size_t(width)), countText(size_t(height)))
                        : tr("Too large: at most %1 megapixels.").arg(kMaxExportPixels / 1e6));
    for (QAbstractButton* button : mButtons->buttons())
        if (mButtons->buttonRole(button) == QDialogButtonBox::AcceptRole) button->setEnabled(fits);
}

ExportRequest ExportDialog::request() const {
    ExportRequest request;
    request.scale = mScale->value() / 100;
    request.options.bitsPerChannel = mDepth->currentData().toInt();
    request.options.jpegQuality = mQuality->value();
    return request;
}

QString ExportDialog::suffix() const {
    return chosen(mFormat).suffix;
}

QString ExportDialog::filter() const {
    return QString("%1 (%2)").arg(chosen(mFormat).name, chosen(mFormat).patterns);
}

}  // namespace tessera
