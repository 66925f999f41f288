// See gl_drawer.h.
#include "ui/gl_drawer.h"

#include <QObject>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <algorithm>
#include <optional>
#include <span>

#include "app/patch_marks.h"
#include "core/base/parallel.h"
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
    // So that a reset of the card is told of, where the driver can.
    format.setOption(QSurfaceFormat::ResetNotification);
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
        (void)render::checkDrawn();  // whatever there was before the first frame is not its error
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
        if (!mTarget)
            mTarget.emplace(view.width, view.height, GL_RGBA8);
        else
            mTarget->resize(view.width, view.height);
        mTarget->bind();
        if (const auto drawn = mRenderer->draw(view, {.showHidden = false}); !drawn)
            return tl::unexpected<Error>(drawn.error());
        QImage image = read(mChannels == 4 || mMarks.leavesHoles());
        if (const auto drawn = render::checkDrawn(); !drawn) return tl::unexpected<Error>(drawn.error());
        return image;
    }

  private:
    GlDrawer() = default;

    // As toQImage() makes one of the CPU's frames.
    QImage read(bool transparent) const {
        const int width = mTarget->width(), height = mTarget->height();
        QImage image(width, height, transparent ? QImage::Format_ARGB32_Premultiplied : QImage::Format_RGB32);
        const std::span pixels(reinterpret_cast<QRgb*>(image.bits()), size_t(width) * size_t(height));
        mTarget->readArgb(pixels);
        parallelFor(pixels.size(), size_t(64) * size_t(width), [&](size_t begin, size_t end) {
            for (QRgb& pixel : pixels.subspan(begin, end - begin)) {
                const int alpha = qAlpha(pixel);
                // Premultiplied values above alpha are what Qt's blending must never see.
                pixel = transparent ? qRgba(std::min(qRed(pixel), alpha), std::min(qGreen(pixel), alpha),
                                            std::min(qBlue(pixel), alpha), alpha)
                                    : pixel | qRgb(0, 0, 0);
            }
        });
        return image;
    }

    bool makeCurrent() { return mContext.isValid() && mContext.makeCurrent(&mSurface); }

    QOffscreenSurface mSurface;
    QOpenGLContext mContext;
    std::optional<render::Renderer> mRenderer;
    std::optional<render::OffscreenTarget> mTarget;
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
