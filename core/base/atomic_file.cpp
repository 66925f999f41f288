// See atomic_file.h.
#include "core/base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <exception>
#include <filesystem>
#include <random>
#include <system_error>

namespace tessera {

namespace {

tl::unexpected<Error> cannotWrite(const std::string& path, const std::string& why) {
    return failure(ErrorCode::CannotWrite, "cannot write \"" + path + "\": " + why);
}

tl::unexpected<Error> cannotWriteErrno(const std::string& path, int error) {
    std::string advice = "; choose another folder or name";
    if (error == ENOSPC || error == EDQUOT) advice = "; free some space on the disk and save again";
    if (error == EACCES || error == EPERM || error == EROFS)
        advice = "; choose a folder in which you may write";
    return cannotWrite(path, std::generic_category().message(error) + advice);
}

// Closes and, unless it was renamed away, removes the temporary whichever way the scope is left.
struct Temporary {
    std::string path;
    int fd = -1;

    Temporary() = default;
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    ~Temporary() {
        if (fd >= 0) ::close(fd);
        if (!path.empty()) ::unlink(path.c_str());
    }
};

// A new file with a name of its own in `folder`. Not mkstemp, which makes files that only their owner may
// read.
int createTemporary(const std::string& folder, Temporary& temporary) {
    std::random_device random;
    for (int attempt = 0; attempt < 100; ++attempt) {
        const std::string path = folder + "/.tessera-" + std::to_string(random()) + ".tmp";
        const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0) {
            temporary.path = path;
            temporary.fd = fd;
            return 0;
        }
        if (errno != EEXIST) return errno;
    }
    return EEXIST;
}

int writeAll(int fd, std::span<const uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(fd, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return errno;
        bytes = bytes.subspan(size_t(count));
    }
    return 0;
}

// Makes the rename itself survive a power cut. Some file systems cannot sync a folder; the file is in place
// then.
void syncFolder(const std::string& folder) {
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) return;
    ::fsync(fd);
    ::close(fd);
}

Result<void> replace(const std::string& path, const std::function<Result<void>(Temporary&)>& fill) {
    std::error_code error;
    std::filesystem::path target(path);
    if (std::filesystem::is_symlink(target, error)) {
        target = std::filesystem::weakly_canonical(target, error);
        if (error) return cannotWriteErrno(path, error.value());
    }
    if (!target.has_filename()) return cannotWrite(path, "it has no file name; add one");
    if (std::filesystem::is_directory(target, error)) return cannotWriteErrno(path, EISDIR);
    const std::string folder = target.has_parent_path() ? target.parent_path().string() : ".";

    Temporary temporary;
    if (const int failed = createTemporary(folder, temporary)) return cannotWriteErrno(path, failed);
    if (Result<void> filled = fill(temporary); !filled) return filled;

    struct stat old{};
    if (::stat(target.c_str(), &old) == 0) ::fchmod(temporary.fd, old.st_mode & 07777);
    if (::fsync(temporary.fd) != 0) return cannotWriteErrno(path, errno);
    if (::rename(temporary.path.c_str(), target.c_str()) != 0) return cannotWriteErrno(path, errno);
    temporary.path.clear();
    syncFolder(folder);
    return {};
}

}  // namespace

Result<void> writeFileAtomically(const std::string& path, std::span<const uint8_t> bytes) {
    return replace(path, [&](const Temporary& temporary) -> Result<void> {
        if (const int failed = writeAll(temporary.fd, bytes)) return cannotWriteErrno(path, failed);
        return {};
    });
}

Result<void> writeFileAtomically(const std::string& path, const WriteTemporary& write) {
    return replace(path, [&](Temporary& temporary) -> Result<void> {
        try {
            if (Result<void> written = write(temporary.path); !written) return written;
        } catch (const std::exception& e) {
            return cannotWrite(path, std::string(e.what()) + "; try again or choose another name");
        }
        // The callback may have put a new file in the place of the one that is open here.
        const int fd = ::open(temporary.path.c_str(), O_RDONLY | O_CLOEXEC);
        if (fd < 0) return cannotWriteErrno(path, errno);
        ::close(temporary.fd);
        temporary.fd = fd;
        return {};
    });
}

}  // namespace tessera
