// See file_service.h.
#include "app/file_service.h"

#include <QBuffer>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QStandardPaths>

#include "core/base/sha256.h"
#include "core/document/codec.h"
#include "core/image/image_io.h"

namespace tessera {

namespace {

using Bytes = std::vector<uint8_t>;

Result<Bytes> readBytes(const QString& path) {
    QFile file(path);
    if (QFileInfo(path).isDir())
        return failure(ErrorCode::CannotRead,
                       QObject::tr("“%1” is a folder; open a picture or a Tessera document in it.")
                           .arg(QFileInfo(path).fileName())
                           .toStdString());
    if (!file.open(QIODevice::ReadOnly))
        return failure(ErrorCode::CannotRead, QObject::tr("“%1” cannot be read: %2.")
                                                  .arg(QFileInfo(path).fileName(), file.errorString())
                                                  .toStdString());
    Bytes bytes(size_t(file.size()));
    const qint64 got = file.read(reinterpret_cast<char*>(bytes.data()), qint64(bytes.size()));
    bytes.resize(size_t(std::max<qint64>(0, got)));
    return bytes;
}

Photo makePhoto(Image image, std::shared_ptr<const Bytes> bytes, const QString& path) {
    Photo photo;
    photo.path = path;
    photo.bytes = std::move(bytes);
    photo.image = std::make_shared<const Image>(std::move(image));
    photo.pyramid = std::make_shared<const PicturePyramid>(toQImage(*photo.image));
    return photo;
}

// The photo of a document that does not embed it, where it lies beside the document and is still the same.
std::shared_ptr<const Bytes> photoBeside(const QString& documentPath, const SourceInfo& source) {
    if (source.fileName.empty() || source.sha256.empty()) return nullptr;
    // Only a plain name: a document must not make us read files anywhere else.
    const QString name = QFileInfo(QString::fromStdString(source.fileName)).fileName();
    auto bytes = readBytes(QFileInfo(documentPath).dir().filePath(name));
    if (!bytes) return nullptr;
    if (sha256Hex(*bytes) != source.sha256) return nullptr;
    return std::make_shared<const Bytes>(std::move(*bytes));
}

Result<OpenedFile> openDocument(const QString& path, const Bytes& file, Progress& progress) {
    Result<Document> document = decodeFile(file, path.toStdString());
    if (!document) return tl::unexpected<Error>(document.error());
    OpenedFile opened{.document = std::move(*document), .photo = {}, .path = path};
    if (!progress.step(.3)) return stopped();
    const SourceInfo& source = opened.document.source;
    const QString photoPath = QFileInfo(path).dir().filePath(QString::fromStdString(source.fileName));
    opened.photo.path = photoPath;
    auto bytes = opened.document.embeddedSource;
    if (!bytes) bytes = photoBeside(path, source);
    if (!bytes) return opened;
    // A photo that cannot be decoded any more is no reason to refuse the document.
    auto photo = readImage(*bytes, source.fileName);
    const PatchMesh& mesh = opened.document.mesh;
    if (photo && photo->image.width() == mesh.width() && photo->image.height() == mesh.height())
        opened.photo = makePhoto(std::move(photo->image), bytes, photoPath);
    return opened;
}

Result<OpenedFile> openPicture(const QString& path, Bytes bytes, Progress& progress) {
    Result<LoadedImage> loaded = readImage(bytes, QFileInfo(path).fileName().toStdString());
    if (!loaded) return tl::unexpected<Error>(loaded.error());
    if (!progress.step(.7)) return stopped();
    OpenedFile opened;
    opened.document.source = std::move(loaded->source);
    opened.document.embeddedSource = std::make_shared<const Bytes>(std::move(bytes));
    opened.photo = makePhoto(std::move(loaded->image), opened.document.embeddedSource, path);
    return opened;
}

}  // namespace

Result<OpenedFile> openFile(const QString& path, Progress& progress) {
    progress.beginStage("reading", 1);
    Result<Bytes> bytes = readBytes(path);
    if (!bytes) return tl::unexpected<Error>(bytes.error());
    if (!progress.step(.1)) return stopped();
    if (looksLikeDocument(*bytes)) return openDocument(path, *bytes, progress);
    return openPicture(path, std::move(*bytes), progress);
}

Result<OpenedFile> openPasted(const QImage& picture, Progress& progress) {
    progress.beginStage("reading", 1);
    QByteArray png;
    QBuffer buffer(&png);
    if (!buffer.open(QIODevice::WriteOnly) || !picture.save(&buffer, "PNG"))
        return failure(ErrorCode::CannotRead, QObject::tr("There is no picture to paste.").toStdString());
    if (!progress.step(.3)) return stopped();
    const QString pictures = QStandardPaths::writableLocation(QStandardPaths::PicturesLocation);
    const QString path = QDir(pictures).filePath(QObject::tr("Pasted Picture") + ".png");
    return openPicture(path, Bytes(png.begin(), png.end()), progress);
}

QString openFilter() {
    return QObject::tr("Photos and Tessera documents") +
           " (*.tessera *.png *.jpg *.jpeg *.tif *.tiff *.exr *.webp *.heic *.avif *.bmp *.gif *.tga *.pnm "
           "*.ppm "
           "*.pgm *.hdr);;" +
           QObject::tr("All files") + " (*)";
}

}  // namespace tessera
