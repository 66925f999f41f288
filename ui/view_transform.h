// Where the picture lies on the screen: a pure value, so that zooming and panning are tested without a
// window.
#pragma once

#include <QPointF>
#include <QRectF>
#include <QSizeF>

namespace tessera {

// Screen coordinates are DEVICE pixels of the canvas (not Qt's logical ones), so that 100 % is one image
// pixel for each pixel of the display whatever its ratio. Image coordinates are image pixels, y down in both.
class ViewTransform {
  public:
    static constexpr double kMinScale = .01;   // 1 %
    static constexpr double kMaxScale = 1000;  // 100,000 %

    double scale() const { return mScale; }     // screen pixels per image pixel
    QPointF origin() const { return mOrigin; }  // screen position of the image's upper left corner

    QPointF toScreen(QPointF image) const { return image * mScale + mOrigin; }
    QPointF toImage(QPointF screen) const { return (screen - mOrigin) / mScale; }
    QRectF toScreen(const QRectF& image) const;

    // Zooms by `factor`, within the limits, the image point under `anchor` (screen) staying where it is. At
    // exactly 100 % the origin is moved to a whole pixel, by at most half of one, so that pixels meet pixels.
    void zoomAt(QPointF anchor, double factor) { setScaleAt(anchor, mScale * factor); }
    void setScaleAt(QPointF anchor, double scale);

    void panBy(QPointF screen);
    // Shows the whole image in the middle of the view with `margin` screen pixels around it, no larger than at
    // the scale `largest`.
    void fit(QSizeF image, QSizeF view, double margin, double largest = 1);
    // Moves the least that leaves some of the image in view.
    void keepInView(QSizeF image, QSizeF view);

    // The next of the usual zoom levels above or below the present one.
    static double nextScale(double scale, bool larger);

    bool operator==(const ViewTransform&) const = default;

  private:
    void alignToPixels();

    double mScale = 1;
    QPointF mOrigin;
};

}  // namespace tessera
