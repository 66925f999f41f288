// A slider whose every use, with mouse, wheel or keys, is one gesture with a beginning and an end.
#pragma once

#include <QSlider>
#include <QTimer>
#include <functional>
#include <optional>

namespace tessera {

// Horizontal. With a neutral value it is dragged relatively, a double click (or Delete) goes back to neutral,
// and the track is filled from there; without one a press goes where it is. The wheel turns it only while it
// has the focus, so that panels scroll. Turns of the wheel and steps that follow each other closely are one
// gesture, which also ends with whatever else the person does: what that is about is then the document with
// the gesture in it, be it undo or another selection. Escape cancels a drag.
class GestureSlider : public QSlider {
    Q_OBJECT

  public:
    explicit GestureSlider(QWidget* parent = nullptr);

    void setNeutral(int value);
    // What the track looks like at a share, 0..1, of its length.
    void setGradient(std::function<QColor(double)> colourAt);
    // Where a value is on the track, in the widget's px.
    double xOf(int value) const;

    // Goes to a value as a key would: as a gesture, or as the next part of the one under way.
    void step(int value);
    // Ends a gesture that waits for further steps.
    void finish();

    QSize sizeHint() const override;
    QSize minimumSizeHint() const override;

  signals:
    // In this order, moved() any number of times; none is begun without a moved().
    void begun();
    void moved(int value);
    void ended();      // the value is what the user wants
    void cancelled();  // the value is again what it was before

  protected:
    bool event(QEvent* event) override;
    bool eventFilter(QObject* watched, QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void keyReleaseEvent(QKeyEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;
    void hideEvent(QHideEvent* event) override;

  private:
    QRectF track() const;
    int valueAt(double x) const;
    void moveTo(int value);
    // Forgets the gesture; whether there was one.
    bool endGesture();
    void cancel();
    // The value that a key asks for.
    std::optional<int> keyTarget(int key) const;

    std::optional<int> mNeutral;
    std::function<QColor(double)> mGradient;
    bool mUnderWay = false;
    int mBefore = 0;  // the value when the gesture began
    bool mPressed = false;
    double mPressX = 0;
    int mPressValue = 0;
    int mWheelDelta = 0;  // of a notch that is not full yet
    QTimer mRest;
};

}  // namespace tessera
