// The whole picture in small, and which part of it the canvas shows.
#pragma once

#include <QImage>
#include <QWidget>

class QLabel;

namespace tessera {

class GestureSlider;
class NavigatorView;

class Navigator : public QWidget {
    Q_OBJECT

  public:
    explicit Navigator(QWidget* parent = nullptr);

    // Any size; of the picture as it is now. Null for none.
    void setPicture(const QImage& picture);
    // What the canvas shows, in image px, and the picture's size in the same.
    void setVisibleRect(const QRectF& imagePx, QSizeF pictureSize);
    // Screen px per image px. Emits nothing.
    void setScale(double scale);

  signals:
    void moveRequested(QPointF imageCentre);
    void zoomRequested(double scale);

  private:
    void request(double scale);

    NavigatorView* mView;
    GestureSlider* mZoom;
    QLabel* mPercent;
    double mScale = 1;
};

// The picture with the frame.
class NavigatorView : public QWidget {
    Q_OBJECT

  public:
    explicit NavigatorView(QWidget* parent = nullptr);

    void setPicture(const QImage& picture);
    void setVisibleRect(const QRectF& imagePx, QSizeF pictureSize);
    // Where the picture is drawn; the frame around what is visible, cut to it. In widget px.
    QRectF pictureRect() const;
    QRectF frameRect() const;

    QSize sizeHint() const override { return {220, 150}; }

  signals:
    void moveRequested(QPointF imageCentre);
    // By that many notches of the wheel.
    void zoomStepRequested(double notches);

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    QPointF toImage(QPointF widget) const;
    QPointF toWidget(QPointF image) const;

    QImage mPicture;
    QImage mScaled;  // mPicture as it was drawn last
    QRectF mVisible;
    QSizeF mSize;
    bool mDragging = false;
    QPointF mGrip;  // from the pointer to the frame's centre, image px
};

}  // namespace tessera
