// See view_transform.h.
#include "ui/view_transform.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera {

namespace {

// As in the editors that designers know; every step is 1.25 to 2 times the one before.
constexpr std::array kLevels{.01,   .02, .03, .05, .0667, .0833, .125, .1667, .25,  .3333, .5,
                             .6667, 1.,  1.5, 2.,  3.,    4.,    6.,   8.,    12.,  16.,   24.,
                             32.,   48., 64., 96., 128.,  192.,  256., 384.,  512., 768.,  1000.};
constexpr double kSameLevel = 1e-3;
// How much of the image always stays in view.
constexpr double kKeptPx = 48;

}  // namespace

QRectF ViewTransform::toScreen(const QRectF& image) const {
    return {toScreen(image.topLeft()), toScreen(image.bottomRight())};
}

void ViewTransform::setScaleAt(QPointF anchor, double scale) {
    const QPointF kept = toImage(anchor);
    mScale = std::clamp(scale, kMinScale, kMaxScale);
    // What a chain of factors leaves beside 1 is rounding.
    if (std::abs(mScale - 1) < 1e-9) mScale = 1;
    mOrigin = anchor - kept * mScale;
    alignToPixels();
}

void ViewTransform::panBy(QPointF screen) {
    mOrigin += screen;
    alignToPixels();
}

void ViewTransform::fit(QSizeF image, QSizeF view, double margin, double largest) {
    if (image.isEmpty() || view.isEmpty()) return;
    const double room =
        std::min((view.width() - 2 * margin) / image.width(), (view.height() - 2 * margin) / image.height());
    mScale = std::clamp(std::min(largest, room), kMinScale, kMaxScale);
    mOrigin = QPointF(view.width() - image.width() * mScale, view.height() - image.height() * mScale) / 2;
    alignToPixels();
}

void ViewTransform::keepInView(QSizeF image, QSizeF view) {
    const auto kept = [&](double origin, double imagePx, double viewPx) {
        const double margin = std::min({kKeptPx, imagePx, viewPx});
        return std::clamp(origin, margin - imagePx, viewPx - margin);
    };
    mOrigin = {kept(mOrigin.x(), image.width() * mScale, view.width()),
               kept(mOrigin.y(), image.height() * mScale, view.height())};
    alignToPixels();
}

double ViewTransform::nextScale(double scale, bool larger) {
    if (larger) {
        for (const double level : kLevels)
            if (level > scale * (1 + kSameLevel)) return level;
        return kMaxScale;
    }
    for (auto level = kLevels.rbegin(); level != kLevels.rend(); ++level)
        if (*level < scale * (1 - kSameLevel)) return *level;
    return kMinScale;
}

void ViewTransform::alignToPixels() {
    if (mScale == 1) mOrigin = {std::round(mOrigin.x()), std::round(mOrigin.y())};
}

}  // namespace tessera
