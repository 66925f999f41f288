// See gl_drawer.h.
#include "ui/gl_drawer.h"

#include <QObject>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <optional>

#include "app/patch_marks.h"
#include "app/picture_pyramid.h"
#include "render/gl_objects.h"
#include "render/offscreen_gl.h"
#include "render/renderer.h"

namespace tessera {

namespace {

QSurfaceFormat core45() {
    QSurfaceFormat format;
    format.setRenderableType(QSurfaceFormat::OpenGL);
    format.setProfile(QSurfaceFormat::CoreProfile);
    format.setVersion(4, 5);
    return format;
}

class GlDrawer : public FrameDrawer {
  public:
    // Null, with the reason in `problem`, where there is no such context, or none but software's and that is
    // not wanted.
    static std::unique_ptr<GlDrawer> create(bool softwareToo, QString& problem) {
        auto drawer = std::unique_ptr<GlDrawer>(new GlDrawer);
        drawer->mContext.setFormat(core45());
        drawer->mSurface.setFormat(core45());
        drawer->mSurface.create();
        if (!drawer->mContext.create() || !drawer->makeCurrent()) {
            problem = QObject::tr("no OpenGL 4.5");
            return nullptr;
        }
        drawer->mDevice = render::currentDevice();
        if (drawer->mDevice.software && !softwareToo) {
            problem = QObject::tr("OpenGL is software here (%1)").arg(drawer->deviceName());
            return nullptr;
        }
        auto renderer = render::Renderer::create();
        if (!renderer) {
            problem = QString::fromStdString(renderer.error().message);
            return nullptr;
        }
        drawer->mRenderer.emplace(std::move(*renderer));
        return drawer;
    }

    ~GlDrawer() override {
        // Objects of the context go while it is current.
        if (makeCurrent()) {
            mTarget.reset();
            mRenderer.reset();
        }
    }

    QString deviceName() const { return QString::fromStdString(mDevice.name); }

    void setMesh(const PatchMesh& mesh) override {
        mRenderer->setMesh(mesh);
        mMarks = PatchMarks(mesh);
        mChannels = mesh.channels();
    }

    void update(const PatchMesh& mesh, std::span<const PatchId> patches) override {
        mRenderer->update(mesh, patches);
        mMarks.update(mesh, patchSet({patches.begin(), patches.end()}));
    }

    Result<QImage> draw(const View& view) override {
        if (!makeCurrent()) return failure(ErrorCode::Internal, "the OpenGL context was lost");
        if (!mTarget || mSize != QSize(view.width, view.height)) {
            mSize = QSize(view.width, view.height);
            mTarget.emplace(view.width, view.height);
        }
        mTarget->bind();
        if (const auto drawn = mRenderer->draw(view, {.showHidden = false}); !drawn)
            return tl::unexpected<Error>(drawn.error());
        const bool transparent = mChannels == 4 || mMarks.leavesHoles();
        return toQImage(mTarget->read(transparent ? 4 : 3));
    }

  private:
    GlDrawer() = default;

    bool makeCurrent() { return mContext.isValid() && mContext.makeCurrent(&mSurface); }

    QOffscreenSurface mSurface;
    QOpenGLContext mContext;
    std::optional<render::Renderer> mRenderer;
    std::optional<render::OffscreenTarget> mTarget;
    QSize mSize;
    render::GlDevice mDevice;
    PatchMarks mMarks;
    int mChannels = 3;
};

}  // namespace

CanvasRenderer makeCanvasRenderer(bool force) {
    QString problem;
    auto drawer = GlDrawer::create(force, problem);
    if (!drawer) return {nullptr, QObject::tr("Drawn by the processor: %1").arg(problem)};
    const QString device = drawer->deviceName();
    return {std::move(drawer), QObject::tr("Drawn by %1").arg(device)};
}

}  // namespace tessera
