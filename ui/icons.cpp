// See icons.h.
#include "ui/icons.h"

#include <QDir>
#include <QFile>
#include <QIconEngine>
#include <QPainter>
#include <QSvgRenderer>

#include "core/base/check.h"

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
    LineIconEngine(QByteArray svg, const QPalette& palette) : mSvg(std::move(svg)), mPalette(palette) {}

    QIconEngine* clone() const override { return new LineIconEngine(*this); }

    void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) override {
        const int side = std::min(rect.width(), rect.height());
        QRectF square(0, 0, side, side);
        square.moveCenter(QRectF(rect).center());
        // Qt's reader knows no currentColor.
        QByteArray tinted = mSvg;
        tinted.replace("currentColor", colourOf(mPalette, mode, state).name().toLatin1());
        QSvgRenderer(tinted).render(painter, square);
    }

    QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
        QPixmap pixmap(size);
        pixmap.fill(Qt::transparent);
        QPainter painter(&pixmap);
        paint(&painter, QRect({}, size), mode, state);
        return pixmap;
    }

  private:
    QByteArray mSvg;
    QPalette mPalette;
};

}  // namespace

QIcon icon(const QString& name, const QPalette& palette) {
    QFile file(kFolder + '/' + name + kSuffix);
    TESSERA_CHECK(file.open(QIODevice::ReadOnly));
    return QIcon(new LineIconEngine(file.readAll(), palette));
}

QStringList iconNames() {
    QStringList names = QDir(kFolder).entryList({'*' + kSuffix}, QDir::Files, QDir::Name);
    for (QString& name : names) name.chop(kSuffix.size());
    return names;
}

}  // namespace tessera
