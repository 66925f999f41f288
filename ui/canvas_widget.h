// The canvas: shows the picture at any zoom, with overlays, and turns wheel, mouse and keys into views and
// into what tools understand.
#pragma once

#include <QColorSpace>
#include <QColorTransform>
#include <QElapsedTimer>
#include <QPointer>
#include <QWidget>
#include <optional>

#include "app/document_session.h"
#include "app/frame_source.h"
#include "app/settings.h"
#include "app/tools/tool_manager.h"
#include "ui/overlay_painter.h"
#include "ui/theme.h"
#include "ui/view_transform.h"

namespace tessera {

class ActionTable;

// Draws the vector image with the CPU renderer where there is one, else the photo. Positions in its interface
// are logical widget coordinates, as Qt's events have them; the view inside is in device pixels.
class CanvasWidget : public QWidget {
    Q_OBJECT

  public:
    explicit CanvasWidget(QWidget* parent = nullptr);

    // Shows another document as it was last seen, at first its whole picture; null shows none. The session
    // outlives this or the next call.
    void setSession(DocumentSession* session);
    void setTheme(Theme theme);
    // That of the window's surface, into which pictures are converted; pictures are shown as they are, in
    // sRGB, where it is not valid.
    void setScreenColours(const QColorSpace& space);
    // Null: the CPU renderer.
    void setDrawer(std::unique_ptr<FrameDrawer> drawer) { mFrames.setDrawer(std::move(drawer)); }
    // Whose tools get what pointer and keys do here, and which keys nudge; the keys outlive the canvas.
    void setTools(ToolManager* tools, const ActionTable& keys);

    const ViewTransform& view() const { return mLook.view; }
    QPointF toImage(QPointF position) const { return mLook.view.toImage(position * devicePixelRatioF()); }
    QPointF toWidget(QPointF image) const { return mLook.view.toScreen(image) / devicePixelRatioF(); }

    // Zooms by steps about the middle of the canvas.
    void zoomStep(bool larger);
    void zoomTo(double scale);
    // The same as a part of what a slider does: to previousZoom() its steps are one change.
    void zoomOnTo(double scale);
    void fit();
    // Makes a part of the picture (image px) fill the canvas.
    void showRect(const QRectF& image);
    // Back to the zoom before the last change of it by the user; a second time, forth again.
    void previousZoom();
    void centreOn(QPointF image);
    // The part of the picture that is in view, in image px.
    QRectF visiblePart() const;

    void setOverlays(const OverlayOptions& options);
    // Shows the photo instead of the vector image for as long as one of the two is on: one is an option, the
    // other a key that is held.
    void setShowOriginal(bool on);
    void setPeeking(bool on);
    // While the key is held, any tool drags the view.
    void setPanHeld(bool on);
    // The photo left of a line that can be dragged, the vector image right of it.
    void setSplit(bool on);
    // The photo in a lens at the pointer.
    void setXRay(bool on);
    // A picture of the size of the document's, painted over it; null for none.
    void setHeatMap(const QImage& map);
    // Shows another mesh of the same picture in place of the document's, which tools leave alone meanwhile;
    // none goes back to the document, and so does a change of it.
    void setDraft(const std::optional<PatchMesh>& draft);
    // Patches that a panel points at.
    void setHighlight(const PatchSet& patches);
    // What is drawn of the whole picture, small; null before there is anything.
    QImage overviewImage() const;
    bool showsPhoto() const;
    // Whether what is on the screen is the view at its full quality.
    bool settled() const { return showsPhoto() || mFrames.settled(); }
    bool drawnWithOpenGl() const { return mFrames.hasDrawer(); }
    bool hasOriginal() const { return mSession && mSession->photo().pyramid; }

  signals:
    void viewChanged();
    // The image point under the cursor and the colour shown there; none where it is outside the picture.
    void cursorMoved(std::optional<QPointF> image, QColor colour);
    // What overviewImage() returns is another one.
    void overviewChanged();
    // OpenGL has failed; the CPU renderer goes on.
    void drawerLost(const QString& reason);
    void contextMenuWanted(QPoint globalPosition);
    // Escape, or a press where a tool would work, while a draft is shown.
    void draftLeft();
    void draftPressed();

  protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    bool event(QEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void contextMenuEvent(QContextMenuEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void keyReleaseEvent(QKeyEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;

  private:
    static constexpr double kLensPx = 110;  // the radius of the X-ray's lens

    QSizeF deviceSize() const { return QSizeF(size()) * devicePixelRatioF(); }
    QRectF deviceRect() const { return QRectF(QPointF(0, 0), deviceSize()); }
    QSizeF pictureSize() const;

    // A view of a document.
    struct Look {
        ViewTransform view;
        bool fitted = true;  // it follows the window until the user zooms or pans
    };
    // All that is remembered of a document that is not shown.
    struct Looks {
        QPointer<DocumentSession> session;
        Look now, before;
        QSizeF laidOut;
    };

    void reloadMesh();
    void showMesh(const PatchMesh& mesh);
    // The tools, while there is something that they may work on.
    ToolManager* toolsInUse() const { return mSession && !mDrafting ? mTools.data() : nullptr; }
    void follow(const Change& change);
    void remakeOverlay();
    void measureFeatures();
    void outlineCutOut();
    void outlineSelection();
    ToolEvent toolEvent(QPointF position, Qt::KeyboardModifiers modifiers) const;
    ToolKey toolKey(const QKeyEvent& event) const;
    void changeViewAsAsked(const ViewRequest& request);
    // The one answer to whether the photo is what is seen there: in the whole canvas, left of the split
    // view's line, or in the lens.
    bool seesPhoto(QPointF devicePosition) const;
    bool showsAnyFrame() const { return mFrames.latest() || mFrames.overview(); }
    bool overSplitLine(QPointF devicePosition) const;
    // Something else is seen at the pointer, which has not moved.
    void lookAgain();
    void hoverAgain(Qt::KeyboardModifiers modifiers);
    bool dragsView(const QMouseEvent& event) const;
    void dragView(QPointF position);
    void rememberLook();
    // Zooms at once, or goes on with what a wheel has begun: the view before is that before all of it.
    void zoomView(const ViewTransform& view);
    void zoomViewOn(const ViewTransform& view);
    // By hand.
    void changeView(const ViewTransform& view) { look({view, false}); }
    void look(const Look& look);
    Look fittedLook() const;
    // Keeps the look of the session that is shown, and takes up that of another one.
    void storeLook();
    void recallLook();
    // The look in a canvas of another size.
    void layOut();
    void requestFrame();
    void updateCursor();
    void reportCursor();
    // At a point within the picture.
    QColor shownColour(QPointF devicePosition) const;

    void paintGround(QPainter& painter);
    // In the colours of the screen.
    void paintPictureManaged(QPainter& painter) const;
    void paintPicture(QPainter& painter) const;
    void paintPhoto(QPainter& painter) const;
    void paintSplit(QPainter& painter) const;
    void paintLens(QPainter& painter) const;
    void paintPixelGrid(QPainter& painter) const;
    void paintOverlays(QPainter& painter) const;
    void paintDraftTag(QPainter& painter) const;
    void paintLegends(QPainter& painter) const;
    void paintVector(QPainter& painter) const;
    void paintFrame(QPainter& painter, const Frame& frame) const;

    DocumentSession* mSession = nullptr;
    QPointer<ToolManager> mTools;
    const ActionTable* mKeys = nullptr;
    PatchMesh mMesh;  // as the frames and overlays show it
    FrameSource mFrames;
    OverlayPainter mOverlay;
    OverlayOptions mOverlays;
    CanvasColours mColours;
    std::optional<QColorTransform> mToScreen;  // from sRGB, where the screen has other colours
    PatchSet mCutOut;
    std::vector<EdgeId> mCutOutOutline;
    std::vector<EdgeId> mSelectionOutline;
    std::vector<EdgeId> mHighlightOutline;
    QImage mHeatMap;
    Look mLook;
    Look mLookBefore;  // the zoom that previousZoom() goes to
    QSizeF mLaidOut;   // device size for which mLook was made
    std::vector<Looks> mOtherLooks;
    QElapsedTimer mSinceZoom;  // steps of a wheel in quick succession are one change of the zoom
    bool mDrafting = false;    // mMesh is a draft
    bool mShowOriginal = false;
    bool mPeeking = false;
    bool mPanHeld = false;
    bool mPanning = false;
    bool mPressed = false;  // a tool has been sent a press
    bool mXRay = false;
    bool mSplit = false;
    bool mDraggingSplit = false;
    double mSplitAt = .5;            // share of the canvas's width
    std::optional<QPointF> mCursor;  // device pixels
};

}  // namespace tessera
