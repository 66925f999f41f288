// A ruler along a side of the canvas, in image pixels.
#pragma once

#include <QWidget>
#include <optional>

#include "ui/view_transform.h"

namespace tessera {

class Ruler : public QWidget {
    Q_OBJECT

  public:
    // Lies along the canvas above it (horizontal) or left of it.
    explicit Ruler(Qt::Orientation orientation, QWidget* parent = nullptr);

    void setView(const ViewTransform& view);
    // The image coordinate that the pointer is at; none where it is elsewhere.
    void setPointer(std::optional<double> image);

    QSize sizeHint() const override;

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    double toWidget(double image) const;

    Qt::Orientation mOrientation;
    ViewTransform mView;
    std::optional<double> mPointer;
};

// The distance of labelled marks: 1, 2 or 5 times a power of ten, at least `leastPx` screen px apart.
double markStep(double scale, double leastPx);

}  // namespace tessera
