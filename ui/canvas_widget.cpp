// See canvas_widget.h. Painting is in canvas_paint.cpp, pointer and keys in canvas_input.cpp.
#include "ui/canvas_widget.h"

#include <algorithm>
#include <cmath>

#include "core/edit/select.h"
#include "ui/conversions.h"

namespace tessera {

namespace {

constexpr double kFitMarginPx = 24;
// Changes of the zoom that follow each other within this time are one.
constexpr int kOneZoomMs = 700;

std::vector<EdgeId> outlineEdges(const PatchMesh& mesh, const PatchSet& set) {
    std::vector<EdgeId> edges;
    for (const auto& loop : outline(mesh, set))
        for (const HalfedgeId h : loop) edges.push_back(HalfedgeMesh::edge(h));
    return edges;
}

void appendEdgesAround(const HalfedgeMesh& mesh, VertexId v, std::vector<EdgeId>& edges) {
    const HalfedgeId first = mesh.halfedge(v);
    HalfedgeId h = first;
    do {
        edges.push_back(HalfedgeMesh::edge(h));
        h = mesh.rotate(h);
    } while (h != first);
}

QCursor cursorOf(ToolCursor cursor) {
    switch (cursor) {
        case ToolCursor::Cross:
            return Qt::CrossCursor;
        case ToolCursor::OpenHand:
            return Qt::OpenHandCursor;
        case ToolCursor::ClosedHand:
            return Qt::ClosedHandCursor;
        case ToolCursor::ZoomIn:
        case ToolCursor::ZoomOut:
            return Qt::SizeAllCursor;
        case ToolCursor::Eyedropper:
            return Qt::CrossCursor;
        case ToolCursor::None:
            return Qt::BlankCursor;
        case ToolCursor::Arrow:
            break;
    }
    return Qt::ArrowCursor;
}

}  // namespace

CanvasWidget::CanvasWidget(QWidget* parent) : QWidget(parent), mColours(canvasColours(Theme::Dark)) {
    setObjectName("canvas");
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setAttribute(Qt::WA_OpaquePaintEvent);
    setMinimumSize(240, 180);
    connect(&mFrames, &FrameSource::drawerLost, this, &CanvasWidget::drawerLost);
    connect(&mFrames, &FrameSource::frameReady, this, [this] {
        update();
        reportCursor();
    });
    connect(&mFrames, &FrameSource::overviewReady, this, &CanvasWidget::overviewChanged);
}

void CanvasWidget::setSession(DocumentSession* session) {
    if (mSession) {
        mSession->disconnect(this);
        mSession->selection().disconnect(this);
        storeLook();
    }
    mSession = session;
    if (mSession) connect(mSession, &DocumentSession::changed, this, &CanvasWidget::follow);
    if (mSession) connect(&mSession->selection(), &Selection::changed, this, &CanvasWidget::outlineSelection);
    reloadMesh();
    recallLook();
}

void CanvasWidget::storeLook() {
    std::erase_if(mOtherLooks,
                  [&](const Looks& looks) { return !looks.session || looks.session == mSession; });
    mOtherLooks.push_back({mSession, mLook, mLookBefore, mLaidOut});
}

void CanvasWidget::recallLook() {
    mSinceZoom.invalidate();
    for (const Looks& looks : mOtherLooks)
        if (mSession && looks.session == mSession) {
            mLook = looks.now;
            mLookBefore = looks.before;
            mLaidOut = looks.laidOut;
            return layOut();
        }
    look(fittedLook());
    mLookBefore = mLook;
}

void CanvasWidget::reloadMesh() {
    mDrafting = false;
    mMesh = mSession ? mSession->document().mesh : PatchMesh();
    mFrames.setMesh(mMesh);
    mHeatMap = {};
    remakeOverlay();
    requestFrame();
    update();
    reportCursor();
    emit overviewChanged();
}

void CanvasWidget::setDraft(const std::optional<PatchMesh>& draft) {
    if (!mSession || (!draft && !mDrafting)) return;
    if (mTools) mTools->cancel();
    mDrafting = draft.has_value();
    showMesh(draft ? *draft : mSession->document().mesh);
    updateCursor();
}

void CanvasWidget::showMesh(const PatchMesh& mesh) {
    // What is on the screen stays until the next frame is there.
    Touched everything;
    everything.topology = true;
    if (mMesh.patchCount() > 0 && mesh.patchCount() > 0)
        mFrames.updateMesh(mesh, everything);
    else
        mFrames.setMesh(mesh);
    mMesh = mesh;
    remakeOverlay();
    requestFrame();
    reportCursor();
}

void CanvasWidget::follow(const Change& change) {
    if (change.photo) update();
    if (!change.mesh()) return;
    if (change.replaced || mDrafting) return reloadMesh();
    const PatchMesh& mesh = mSession->document().mesh;
    mFrames.updateMesh(mesh, change.touched);
    mMesh = mesh;
    if (change.touched.topology) {
        remakeOverlay();
    } else {
        std::vector<EdgeId> edges = change.touched.edges;
        for (const VertexId v : change.touched.vertices) appendEdgesAround(mMesh.connectivity(), v, edges);
        if (mOverlay.measuresJumps())
            for (const PatchId p : change.touched.patches)
                for (const HalfedgeId h : mMesh.connectivity().sides(p))
                    edges.push_back(HalfedgeMesh::edge(h));
        mOverlay.update(mMesh, edges);
        outlineCutOut();
    }
    update();
}

void CanvasWidget::remakeOverlay() {
    mOverlay = OverlayPainter(mMesh);
    mHighlightOutline.clear();
    mCutOut.clear();
    mCutOutOutline.clear();
    outlineCutOut();
    outlineSelection();
    measureFeatures();
}

void CanvasWidget::measureFeatures() {
    if (mOverlays.tint == FeatureTint::Importance && !mOverlay.measuresJumps()) mOverlay.measureJumps(mMesh);
}

void CanvasWidget::outlineCutOut() {
    const PatchSet cutOut = mSession && !mDrafting ? mSession->marks().cutOut() : PatchSet();
    if (cutOut == mCutOut) return;
    mCutOut = cutOut;
    mCutOutOutline = outlineEdges(mMesh, mCutOut);
}

void CanvasWidget::outlineSelection() {
    // Of the document: where patches come or go, the selection knows them before mMesh does.
    mSelectionOutline = mSession && mSession->hasMesh() && !mDrafting
                            ? outlineEdges(mSession->document().mesh, mSession->selection().patches())
                            : std::vector<EdgeId>();
    update();
}

void CanvasWidget::setHighlight(const PatchSet& patches) {
    mHighlightOutline = mDrafting ? std::vector<EdgeId>() : outlineEdges(mMesh, patches);
    update();
}

void CanvasWidget::setHeatMap(const QImage& map) {
    mHeatMap = map;
    update();
}

QImage CanvasWidget::overviewImage() const {
    if (!mSession) return {};
    if (mFrames.overview()) return mFrames.overview()->image;
    return hasOriginal() ? mSession->photo().pyramid->levelFor(.1) : QImage();
}

void CanvasWidget::setTools(ToolManager* tools, const ActionTable& keys) {
    mTools = tools;
    mKeys = &keys;
    connect(tools, &ToolManager::overlayChanged, this, [this] {
        updateCursor();
        update();
    });
    connect(tools, &ToolManager::toolChanged, this, &CanvasWidget::updateCursor);
    connect(tools, &ToolManager::viewRequested, this, &CanvasWidget::changeViewAsAsked);
}

void CanvasWidget::setTheme(Theme theme) {
    mColours = canvasColours(theme);
    update();
}

void CanvasWidget::setScreenColours(const QColorSpace& space) {
    const QColorSpace pictures(QColorSpace::SRgb);
    mToScreen.reset();
    if (space.isValid() && space != pictures) mToScreen = pictures.transformationToColorSpace(space);
    update();
}

QSizeF CanvasWidget::pictureSize() const {
    return mSession ? QSizeF(mSession->width(), mSession->height()) : QSizeF();
}

bool CanvasWidget::showsPhoto() const {
    if (!hasOriginal()) return false;
    return mMesh.patchCount() == 0 || mShowOriginal || mPeeking;
}

void CanvasWidget::setShowOriginal(bool on) {
    mShowOriginal = on;
    lookAgain();
}

void CanvasWidget::setSplit(bool on) {
    mSplit = on;
    lookAgain();
}

void CanvasWidget::setXRay(bool on) {
    mXRay = on;
    lookAgain();
}

void CanvasWidget::setOverlays(const OverlayOptions& options) {
    mOverlays = options;
    measureFeatures();
    update();
}

void CanvasWidget::zoomStep(bool larger) {
    zoomTo(ViewTransform::nextScale(mLook.view.scale(), larger));
}

void CanvasWidget::zoomTo(double scale) {
    ViewTransform view = mLook.view;
    view.setScaleAt(deviceRect().center(), scale);
    zoomView(view);
}

void CanvasWidget::zoomOnTo(double scale) {
    ViewTransform view = mLook.view;
    view.setScaleAt(deviceRect().center(), scale);
    zoomViewOn(view);
}

CanvasWidget::Look CanvasWidget::fittedLook() const {
    ViewTransform fitted = mLook.view;
    const double ratio = devicePixelRatioF();
    fitted.fit(pictureSize(), deviceSize(), kFitMarginPx * ratio, ratio);
    return {fitted, true};
}

void CanvasWidget::fit() {
    rememberLook();
    look(fittedLook());
}

void CanvasWidget::showRect(const QRectF& image) {
    if (!mSession || image.isEmpty()) return;
    const double margin = kFitMarginPx * devicePixelRatioF();
    const double scale = std::min((deviceSize().width() - 2 * margin) / image.width(),
                                  (deviceSize().height() - 2 * margin) / image.height());
    ViewTransform view = mLook.view;
    view.setScaleAt(deviceRect().center(), scale);
    view.panBy(deviceRect().center() - view.toScreen(image.center()));
    zoomView(view);
}

void CanvasWidget::centreOn(QPointF image) {
    ViewTransform view = mLook.view;
    view.panBy(deviceRect().center() - view.toScreen(image));
    view.keepInView(pictureSize(), deviceSize());
    changeView(view);
}

void CanvasWidget::previousZoom() {
    Look before = mLookBefore.fitted ? fittedLook() : mLookBefore;
    before.view.keepInView(pictureSize(), deviceSize());
    rememberLook();
    look(before);
}

QRectF CanvasWidget::visiblePart() const {
    return QRectF(mLook.view.toImage(deviceRect().topLeft()),
                  mLook.view.toImage(deviceRect().bottomRight())) &
           QRectF(QPointF(0, 0), pictureSize());
}

void CanvasWidget::changeViewAsAsked(const ViewRequest& request) {
    if (const auto* pan = std::get_if<PanBy>(&request)) {
        ViewTransform view = mLook.view;
        view.panBy(toPoint(pan->offset) * mLook.view.scale());
        view.keepInView(pictureSize(), deviceSize());
        changeView(view);
    } else if (const auto* step = std::get_if<ZoomStep>(&request)) {
        ViewTransform view = mLook.view;
        view.setScaleAt(mLook.view.toScreen(toPoint(step->at)),
                        ViewTransform::nextScale(mLook.view.scale(), step->in));
        zoomView(view);
    } else {
        showRect(toRect(std::get<ShowRect>(request).rect));
    }
}

void CanvasWidget::rememberLook() {
    mLookBefore = mLook;
    mSinceZoom.invalidate();
}

void CanvasWidget::zoomView(const ViewTransform& view) {
    rememberLook();
    changeView(view);
}

void CanvasWidget::zoomViewOn(const ViewTransform& view) {
    if (!mSinceZoom.isValid() || mSinceZoom.elapsed() > kOneZoomMs) mLookBefore = mLook;
    mSinceZoom.start();
    changeView(view);
}

void CanvasWidget::look(const Look& look) {
    mLook = look;
    mLaidOut = deviceSize();
    requestFrame();
    update();
    reportCursor();
    emit viewChanged();
}

void CanvasWidget::requestFrame() {
    if (!mSession || mMesh.patchCount() == 0) return;
    // Only pixels that lie wholly within the picture: what is outside is black or clear, and would darken the
    // border.
    const QRectF part = mLook.view.toScreen(QRectF(QPointF(0, 0), pictureSize())) & deviceRect();
    const double left = std::ceil(part.left()), top = std::ceil(part.top());
    const QPointF origin = mLook.view.toImage({left, top});
    View view;
    view.origin = {origin.x(), origin.y()};
    view.scale = {mLook.view.scale(), mLook.view.scale()};
    view.width = int(std::floor(part.right()) - left);
    view.height = int(std::floor(part.bottom()) - top);
    if (view.width > 0 && view.height > 0) mFrames.request(view);
}

void CanvasWidget::layOut() {
    if (mLook.fitted || mLaidOut.isEmpty()) return look(fittedLook());
    // What was in the middle stays there.
    ViewTransform view = mLook.view;
    const QSizeF grown = deviceSize() - mLaidOut;
    view.panBy(QPointF(grown.width(), grown.height()) / 2);
    view.keepInView(pictureSize(), deviceSize());
    changeView(view);
}

void CanvasWidget::resizeEvent(QResizeEvent*) {
    layOut();
}

void CanvasWidget::updateCursor() {
    if (mPanning)
        setCursor(Qt::ClosedHandCursor);
    else if (mPanHeld)
        setCursor(Qt::OpenHandCursor);
    else if (mDraggingSplit || (mCursor && overSplitLine(*mCursor)))
        setCursor(Qt::SplitHCursor);
    else
        setCursor(cursorOf(toolsInUse() ? mTools->cursor() : ToolCursor::Arrow));
}

void CanvasWidget::reportCursor() {
    std::optional<QPointF> image;
    if (mCursor && mSession) {
        const QPointF point = mLook.view.toImage(*mCursor);
        // A point on the right or lower border is in no pixel.
        const QSizeF size = pictureSize();
        if (point.x() >= 0 && point.y() >= 0 && point.x() < size.width() && point.y() < size.height())
            image = point;
    }
    emit cursorMoved(image, image ? shownColour(*mCursor) : QColor());
}

}  // namespace tessera
