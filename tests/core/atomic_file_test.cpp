// A file that is written atomically is there whole, or the old one still is, and nothing else is left in the
// folder.
#include "core/base/atomic_file.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

namespace tessera {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public tessera::testing::TemporaryFolderTest {
  protected:
    size_t entryCount() const {
        return size_t(std::distance(fs::directory_iterator(mFolder), fs::directory_iterator()));
    }
    static std::vector<uint8_t> bytesOf(std::string_view text) { return {text.begin(), text.end()}; }
};

TEST_F(AtomicFile, WritesNewAndReplacesOld) {
    ASSERT_TRUE(writeFileAtomically(at("a.bin"), bytesOf("first")));
    EXPECT_EQ(contentOf("a.bin"), "first");
    ASSERT_TRUE(writeFileAtomically(at("a.bin"), bytesOf("2")));
    EXPECT_EQ(contentOf("a.bin"), "2");
    ASSERT_TRUE(writeFileAtomically(at("a.bin"), bytesOf("")));
    EXPECT_EQ(contentOf("a.bin"), "");
    EXPECT_EQ(entryCount(), 1u);
}

TEST_F(AtomicFile, NewFilesFollowTheUmaskAndOldOnesKeepTheirMode) {
    const mode_t old = ::umask(0022);
    ASSERT_TRUE(writeFileAtomically(at("a"), bytesOf("x")));
    ::umask(old);
    EXPECT_EQ(fs::status(at("a")).permissions(), fs::perms(0644));
    fs::permissions(at("a"), fs::perms(0600));
    ASSERT_TRUE(writeFileAtomically(at("a"), bytesOf("y")));
    EXPECT_EQ(fs::status(at("a")).permissions(), fs::perms(0600));
}

TEST_F(AtomicFile, FollowsASymbolicLink) {
    ASSERT_TRUE(writeFileAtomically(at("real"), bytesOf("old")));
    fs::create_symlink("real", at("link"));
    ASSERT_TRUE(writeFileAtomically(at("link"), bytesOf("new")));
    EXPECT_TRUE(fs::is_symlink(at("link")));
    EXPECT_EQ(contentOf("real"), "new");
}

TEST_F(AtomicFile, FailureInTheCallbackLeavesTheOldFile) {
    ASSERT_TRUE(writeFileAtomically(at("a"), bytesOf("old")));
    const auto half = [](const std::string& path) -> Result<void> {
        std::ofstream(path) << "half of it";
        return failure(ErrorCode::CannotWrite, "no more");
    };
    const Result<void> failed = writeFileAtomically(at("a"), WriteTemporary(half));
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "no more");
    const auto throwing = [](const std::string&) -> Result<void> { throw std::runtime_error("thrown"); };
    const Result<void> thrown = writeFileAtomically(at("a"), WriteTemporary(throwing));
    ASSERT_FALSE(thrown);
    EXPECT_EQ(thrown.error().code, ErrorCode::CannotWrite);
    const auto removing = [](const std::string& path) -> Result<void> {
        fs::remove(path);
        return {};
    };
    EXPECT_FALSE(writeFileAtomically(at("a"), WriteTemporary(removing)));
    EXPECT_EQ(contentOf("a"), "old");
    EXPECT_EQ(entryCount(), 1u);
}

TEST_F(AtomicFile, CallbackMayReplaceTheTemporary) {
    const auto replacing = [](const std::string& path) -> Result<void> {
        fs::remove(path);
        std::ofstream(path) << "fresh";
        return {};
    };
    ASSERT_TRUE(writeFileAtomically(at("a"), WriteTemporary(replacing)));
    EXPECT_EQ(contentOf("a"), "fresh");
    EXPECT_EQ(entryCount(), 1u);
}

TEST_F(AtomicFile, NamesTheFileThatCannotBeWritten) {
    for (const std::string& path : {at("no/such/folder/a"), at("") + "/", mFolder.string()}) {
        const Result<void> result = writeFileAtomically(path, bytesOf("x"));
        ASSERT_FALSE(result) << path;
        EXPECT_EQ(result.error().code, ErrorCode::CannotWrite);
        EXPECT_NE(result.error().message.find(path), std::string::npos) << result.error().message;
    }
    EXPECT_EQ(entryCount(), 0u);
}

}  // namespace
}  // namespace tessera
