// See icons.h.
#include "ui/icons.h"

#include <QDir>
#include <QFile>
#include <QIconEngine>
#include <QPainter>
#include <memory>

#include "core/base/check.h"
#include "ui/svg_drawing.h"

namespace tessera {

namespace {

const QString kFolder = ":/icons/line";
const QString kSuffix = ".svg";

QColor colourOf(const QPalette& palette, QIcon::Mode mode, QIcon::State state) {
    switch (mode) {
        case QIcon::Disabled:
            return palette.color(QPalette::Disabled, QPalette::ButtonText);
        case QIcon::Selected:
            return palette.color(QPalette::Active, QPalette::HighlightedText);
        default:
            return palette.color(QPalette::Active,
                                 state == QIcon::On ? QPalette::Highlight : QPalette::ButtonText);
    }
}

class LineIconEngine : public QIconEngine {
  public:
    LineIconEngine(std::shared_ptr<const SvgDrawing> drawing, const QPalette& palette)
        : mDrawing(std::move(drawing)), mPalette(palette) {}

    QIconEngine* clone() const override { return new LineIconEngine(*this); }

    void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) override {
        const int side = std::min(rect.width(), rect.height());
        QRectF square(0, 0, side, side);
        square.moveCenter(QRectF(rect).center());
        mDrawing->paint(*painter, square, colourOf(mPalette, mode, state));
    }

    QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
        QPixmap pixmap(size);
        pixmap.fill(Qt::transparent);
        QPainter painter(&pixmap);
        paint(&painter, QRect({}, size), mode, state);
        return pixmap;
    }

  private:
    std::shared_ptr<const SvgDrawing> mDrawing;
    QPalette mPalette;
};

}  // namespace

QIcon icon(const QString& name, const QPalette& palette) {
    QFile file(kFolder + '/' + name + kSuffix);
    TESSERA_CHECK(file.open(QIODevice::ReadOnly));
    auto drawing = readSvgDrawing(file.readAll());
    TESSERA_CHECK(drawing.has_value());
    return QIcon(new LineIconEngine(std::make_shared<const SvgDrawing>(std::move(*drawing)), palette));
}

QStringList iconNames() {
    QStringList names = QDir(kFolder).entryList({'*' + kSuffix}, QDir::Files, QDir::Name);
    for (QString& name : names) name.chop(kSuffix.size());
    return names;
}

}  // namespace tessera
