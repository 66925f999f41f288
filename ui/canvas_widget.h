// The canvas: shows the picture at any zoom, with overlays, and turns wheel, mouse and keys into views.
#pragma once

#include <QWidget>
#include <optional>

#include "app/document_session.h"
#include "app/frame_source.h"
#include "app/settings.h"
#include "ui/overlay_painter.h"
#include "ui/theme.h"
#include "ui/view_transform.h"

namespace tessera {

// Draws the vector image with the CPU renderer where there is one, else the photo. Positions in its interface
// are logical widget coordinates, as Qt's events have them; the view inside is in device pixels.
class CanvasWidget : public QWidget {
    Q_OBJECT

  public:
    explicit CanvasWidget(QWidget* parent = nullptr);

    // Shows another document from its whole picture on; null shows none. The session outlives this or the
    // next call.
    void setSession(DocumentSession* session);
    void setTheme(Theme theme);

    const ViewTransform& view() const { return mView; }
    QPointF toImage(QPointF position) const { return mView.toImage(position * devicePixelRatioF()); }
    QPointF toWidget(QPointF image) const { return mView.toScreen(image) / devicePixelRatioF(); }

    // Zooms by steps about the middle of the canvas.
    void zoomStep(bool larger);
    void zoomTo(double scale);
    void fit();

    void setOverlays(const OverlayOptions& options);
    size_t featureCount() const { return mOverlay.featureCount(); }
    // Shows the photo instead of the vector image for as long as it is on. Holding O does the same.
    void setShowOriginal(bool on);
    bool showsPhoto() const;
    // Whether what is on the screen is the view at its full quality.
    bool settled() const { return showsPhoto() || mFrames.settled(); }

  signals:
    void viewChanged();
    // The image point under the cursor and the colour shown there; none where it is outside the picture.
    void cursorMoved(std::optional<QPointF> image, QColor colour);

  protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    bool event(QEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void keyReleaseEvent(QKeyEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;

  private:
    QSizeF deviceSize() const { return QSizeF(size()) * devicePixelRatioF(); }
    QRectF deviceRect() const { return QRectF(QPointF(0, 0), deviceSize()); }
    QSizeF pictureSize() const;

    void reloadMesh();
    void changeView(const ViewTransform& view);
    void requestFrame();
    void updateCursor();
    void reportCursor();
    QColor shownColour(QPointF image) const;

    void paintGround(QPainter& painter);
    void paintPhoto(QPainter& painter) const;
    void paintVector(QPainter& painter) const;
    void paintFrame(QPainter& painter, const Frame& frame) const;

    DocumentSession* mSession = nullptr;
    FrameSource mFrames;
    OverlayPainter mOverlay;
    OverlayOptions mOverlays;
    CanvasColours mColours;
    ViewTransform mView;
    QSizeF mLaidOut;      // device size for which mView was made
    bool mFitted = true;  // the view follows the window until the user zooms or pans
    bool mShowOriginal = false;
    bool mPeeking = false;  // O is held
    bool mSpace = false;    // Space is held
    bool mPanning = false;
    std::optional<QPointF> mCursor;  // device pixels
};

}  // namespace tessera
