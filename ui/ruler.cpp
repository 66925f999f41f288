// See ruler.h.
#include "ui/ruler.h"

#include <QLocale>
#include <QPainter>
#include <cmath>

namespace tessera {

namespace {

constexpr int kThicknessPx = 20;
constexpr double kLeastMarkPx = 64;
constexpr int kPartsOfMark = 5;

}  // namespace

double markStep(double scale, double leastPx) {
    const double least = leastPx / scale;
    const double power = std::pow(10., std::floor(std::log10(least)));
    for (const double factor : {1., 2., 5.})
        if (factor * power >= least) return factor * power;
    return 10 * power;
}

Ruler::Ruler(Qt::Orientation orientation, QWidget* parent) : QWidget(parent), mOrientation(orientation) {
    const bool horizontal = orientation == Qt::Horizontal;
    setSizePolicy(horizontal ? QSizePolicy::Expanding : QSizePolicy::Fixed,
                  horizontal ? QSizePolicy::Fixed : QSizePolicy::Expanding);
    setAccessibleName(horizontal ? tr("Horizontal ruler") : tr("Vertical ruler"));
}

QSize Ruler::sizeHint() const {
    return {kThicknessPx, kThicknessPx};
}

void Ruler::setView(const ViewTransform& view) {
    mView = view;
    update();
}

void Ruler::setPointer(std::optional<double> image) {
    mPointer = image;
    update();
}

double Ruler::toWidget(double image) const {
    const QPointF at = mView.toScreen(QPointF(image, image)) / devicePixelRatioF();
    return mOrientation == Qt::Horizontal ? at.x() : at.y();
}

void Ruler::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), palette().color(QPalette::Window));
    const bool horizontal = mOrientation == Qt::Horizontal;
    // One code for both: the vertical ruler is the horizontal one, turned.
    if (!horizontal) {
        painter.rotate(90);
        painter.scale(1, -1);
    }
    const int length = horizontal ? width() : height();
    const double scale = mView.scale() / devicePixelRatioF(), step = markStep(scale, kLeastMarkPx);
    const double part = step / kPartsOfMark;
    const QPointF corner = mView.toImage(QPointF(0, 0));
    const double first = std::floor((horizontal ? corner.x() : corner.y()) / part) * part;
    QFont small = font();
    small.setPointSizeF(small.pointSizeF() * .75);
    painter.setFont(small);
    painter.setPen(palette().color(QPalette::PlaceholderText));
    const int count = int(length / (part * scale)) + 2;
    for (int i = 0; i <= count; ++i) {
        const double value = first + i * part, x = std::round(toWidget(value)) + .5;
        const bool labelled = std::abs(std::remainder(value, step)) < part / 2;
        painter.drawLine(QPointF(x, labelled ? 2 : kThicknessPx - 5), QPointF(x, kThicknessPx));
        if (!labelled) continue;
        painter.save();
        painter.translate(x + 3, 2);
        if (!horizontal) painter.scale(1, -1), painter.translate(0, -kThicknessPx + 6);
        painter.drawText(QPointF(0, painter.fontMetrics().ascent()), QLocale().toString(value, 'g', 6));
        painter.restore();
    }
    if (mPointer) {
        const double x = toWidget(*mPointer);
        painter.setPen(palette().color(QPalette::Highlight));
        painter.drawLine(QPointF(x, 0), QPointF(x, kThicknessPx));
    }
}

}  // namespace tessera
