// Reading of image_io.h: a file's bytes, the samples that a decoder finds in them, the working space. Writing
// is in image_write.cpp.
#include "core/image/image_io.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <new>
#include <system_error>

#include "core/base/parallel.h"
#include "core/base/sha256.h"
#include "core/image/image_source.h"

namespace tessera {

namespace {

tl::unexpected<Error> cannotRead(const std::string& name, const std::string& why) {
    return failure(ErrorCode::CannotRead, "cannot read \"" + name + "\": " + why);
}

Result<std::vector<uint8_t>> readFile(const std::string& path) {
    const auto fail = [&](int error) {
        const char* advice = "; check the disk and try again";
        if (error == ENOENT || error == ENOTDIR) advice = "; check the name";
        if (error == EACCES) advice = "; ask its owner for permission to read it";
        return cannotRead(path, std::generic_category().message(error) + advice);
    };
    // Not to wait for ever on the other end of a pipe: anything but a regular file is turned down below.
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return fail(errno);
    struct Closer {
        int fd;
        ~Closer() { ::close(fd); }
    } const closer{fd};
    struct stat status{};
    if (::fstat(fd, &status) != 0) return fail(errno);
    if (S_ISDIR(status.st_mode)) return cannotRead(path, "it is a folder; choose a picture in it");
    if (!S_ISREG(status.st_mode)) return cannotRead(path, "it is not a file; choose a picture");
    std::vector<uint8_t> bytes(size_t(status.st_size));
    size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count = ::read(fd, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return fail(errno);
        if (count == 0) break;
        done += size_t(count);
    }
    bytes.resize(done);
    return bytes;
}

// Where the pixels of a stored row go: pixel (x, y) of the file lands at origin + x * stepX + y * stepY of a
// plane.
struct Placement {
    int width;  // after turning
    int height;
    ptrdiff_t origin;
    ptrdiff_t stepX;
    ptrdiff_t stepY;
};

// EXIF 2.3, table of Orientation: where the stored first row and first column lie in the picture as it is
// seen.
Placement placementFor(int orientation, int storedWidth, int storedHeight) {
    const bool transposed = orientation >= 5;
    const bool mirrorX = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
    const bool mirrorY = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
    Placement place{};
    place.width = transposed ? storedHeight : storedWidth;
    place.height = transposed ? storedWidth : storedHeight;
    const ptrdiff_t along = mirrorX ? -1 : 1;
    const ptrdiff_t down = (mirrorY ? -1 : 1) * ptrdiff_t(place.width);
    place.stepX = transposed ? down : along;
    place.stepY = transposed ? along : down;
    place.origin =
        (mirrorX ? place.width - 1 : 0) + (mirrorY ? ptrdiff_t(place.height - 1) * place.width : 0);
    return place;
}

// The buffers of one thread for one row.
struct RowBuffers {
    std::vector<float> samples, alpha, rgb;

    RowBuffers(size_t width, size_t count) : samples(width * count), alpha(width, 1), rgb(width * 3) {}
};

float finite(float value) {
    return std::isfinite(value) ? value : 0;
}

// One stored row into the working space, at its place. Returns whether all of it is opaque.
bool convertRow(const ImageSource& source, const float* stored, const Placement& place, int y,
                RowBuffers& row, Image& image) {
    const auto width = size_t(source.info.width);
    const size_t count = source.color.size();
    bool opaque = true;
    for (size_t x = 0; x < width; ++x) {
        const float* pixel = stored + x * source.channels;
        if (source.alpha >= 0) row.alpha[x] = std::clamp(finite(pixel[source.alpha]), 0.f, 1.f);
        const float alpha = row.alpha[x];
        opaque = opaque && alpha >= 1;
        for (size_t c = 0; c < count; ++c) {
            const float sample = finite(pixel[source.color[c]]);
            row.samples[x * count + c] = !source.associated || alpha <= 0 ? sample : finite(sample / alpha);
        }
    }
    source.converter.convert(row.samples, width, row.rgb);
    for (size_t c = 0; c < 3; ++c) {
        float* out = image.plane(int(c)).data() + place.origin + y * place.stepY;
        for (size_t x = 0; x < width; ++x)
            out[ptrdiff_t(x) * place.stepX] = finite(row.rgb[3 * x + c]) * row.alpha[x];
    }
    if (image.hasAlpha()) {
        float* out = image.plane(3).data() + place.origin + y * place.stepY;
        for (size_t x = 0; x < width; ++x) out[ptrdiff_t(x) * place.stepX] = row.alpha[x];
    }
    return opaque;
}

Image withoutAlpha(const Image& image) {
    Image opaque(image.width(), image.height(), 3);
    for (int c = 0; c < 3; ++c) std::ranges::copy(image.plane(c), opaque.plane(c).begin());
    return opaque;
}

Result<Image> decode(const ImageSource& source) {
    const int height = source.info.height;
    const auto width = size_t(source.info.width);
    const Placement place = placementFor(source.orientation, source.info.width, height);
    Image image(place.width, place.height, source.alpha >= 0 ? 4 : 3);
    const size_t rowSize = width * source.channels;
    std::vector<float> band(rowSize * size_t(std::min(source.rowStep, height)));
    std::atomic<bool> opaque = true;
    for (int begin = 0; begin < height; begin += source.rowStep) {
        const int end = std::min(begin + source.rowStep, height);
        if (Result<void> read = source.readRows(begin, end, band); !read) return tl::unexpected(read.error());
        constexpr size_t kGrainPixels = 16384;
        parallelFor(size_t(end - begin), 1 + kGrainPixels / width, [&](size_t first, size_t last) {
            RowBuffers buffers(width, source.color.size());
            for (size_t i = first; i < last; ++i)
                if (!convertRow(source, band.data() + i * rowSize, place, begin + int(i), buffers, image))
                    opaque = false;
        });
    }
    return image.hasAlpha() && opaque ? withoutAlpha(image) : std::move(image);
}

// `name` is for messages. The one place where exceptions of the libraries below are caught.
Result<LoadedImage> readBytes(const std::vector<uint8_t>& bytes, const std::string& name,
                              const ReadLimits& limits) {
    try {
        Result<ImageSource> source = openImageSource(bytes, limits);
        if (!source) return cannotRead(name, source.error().message);
        Result<Image> image = decode(*source);
        if (!image) return cannotRead(name, image.error().message);
        SourceInfo info = std::move(source->info);
        info.fileName = std::filesystem::path(name).filename().string();
        info.byteSize = bytes.size();
        info.sha256 = sha256Hex(bytes);
        info.width = image->width();
        info.height = image->height();
        return LoadedImage{std::move(*image), std::move(info)};
    } catch (const std::bad_alloc&) {
        return cannotRead(name, "there is not enough memory for it; scale it down or close other programs");
    } catch (const std::exception& e) {
        return cannotRead(name, std::string("it is damaged (") + e.what() + "); get the file again");
    } catch (...) {
        return cannotRead(name, "it is damaged; get the file again from where it came");
    }
}

}  // namespace

Result<LoadedImage> readImage(const std::string& path, const ReadLimits& limits) {
    try {
        const Result<std::vector<uint8_t>> bytes = readFile(path);
        if (!bytes) return tl::unexpected(bytes.error());
        return readBytes(*bytes, path, limits);
    } catch (const std::exception&) {
        return cannotRead(path, "there is not enough memory for it; close other programs");
    }
}

Result<LoadedImage> readImage(const std::vector<uint8_t>& bytes, const std::string& fileName,
                              const ReadLimits& limits) {
    return readBytes(bytes, fileName, limits);
}

}  // namespace tessera
