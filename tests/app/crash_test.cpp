// A process that is killed at each of its writes leaves the old document or the new one, in its file or in
// the recovery folder.
//
// The child of these tests is this program itself, run with one test and told by its environment when to die.
// It dies in the functions below, which take the place of the C library's in the whole program, Qt included.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QFileInfo>
#include <algorithm>
#include <string>

#include "app/recovery_store.h"
#include "core/document/codec.h"
#include "tests/support/edits.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_meshes.h"

namespace {

int gWritesLeft = 0;  // until the process dies; 0: it lives

bool dies() {
    return gWritesLeft > 0 && --gWritesLeft == 0;
}

[[noreturn]] void die() {
    ::kill(::getpid(), SIGKILL);
    ::pause();
    std::abort();
}

}  // namespace

extern "C" {

ssize_t write(int fd, const void* bytes, size_t count) {
    if (dies()) {
        ::syscall(SYS_write, fd, bytes, count / 2);
        die();
    }
    return ::syscall(SYS_write, fd, bytes, count);
}

int fsync(int fd) {
    if (dies()) die();
    return int(::syscall(SYS_fsync, fd));
}

int rename(const char* from, const char* to) noexcept {
    if (dies()) die();
    return int(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

int unlink(const char* path) noexcept {
    if (dies()) die();
    return int(::syscall(SYS_unlinkat, AT_FDCWD, path, 0));
}

}  // extern "C"

namespace tessera {
namespace {

Document painted(float value) {
    Document document;
    document.mesh = testing::gridMesh(40, 30, 4, 3);
    testing::paint(document.mesh, PatchId(3), value);
    return document;
}

const RecoveryInfo kInfo{"a.tessera", "a.png", QDateTime(QDate(2026, 1, 2), QTime(3, 4), Qt::UTC)};

// What a session with one document does to the disk. States of the document are .1 (in the file before), .2,
// .3; each phase that is over is told by a byte on stdout.
TEST(CrashChild, Run) {
    const char* folder = std::getenv("TESSERA_CRASH_FOLDER");
    if (!folder) GTEST_SKIP() << "run by the tests of the other suite";
    const std::string root = std::string(folder) + "/recovery", file = std::string(folder) + "/a.tessera";
    const auto done = [](char phase) { ::syscall(SYS_write, STDOUT_FILENO, &phase, 1); };
    gWritesLeft = std::atoi(std::getenv("TESSERA_CRASH_AT"));
    RecoveryStore store(QString::fromStdString(root));
    const auto slot = store.newSlot();
    ASSERT_TRUE(slot->write(painted(.2f), kInfo));
    done('A');
    ASSERT_TRUE(slot->write(painted(.3f), kInfo));
    done('B');
    Document document = painted(.3f);
    ASSERT_TRUE(saveDocument(document, file));
    done('C');
    slot->forget();
    done('D');
    gWritesLeft = 0;
}

class CrashTest : public testing::TemporaryFolderTest {
  protected:
    struct Outcome {
        bool killed = false;
        std::string phases;  // that were over
    };

    // Runs the child until its write number `at`.
    Outcome run(int at) const {
        int out[2];
        EXPECT_EQ(::pipe(out), 0);
        const pid_t child = ::fork();
        if (child == 0) {
            ::dup2(out[1], STDOUT_FILENO);
            ::setenv("TESSERA_CRASH_FOLDER", mFolder.c_str(), 1);
            ::setenv("TESSERA_CRASH_AT", std::to_string(at).c_str(), 1);
            ::execl("/proc/self/exe", "crash_test", "--gtest_filter=CrashChild.Run", "--gtest_brief=1",
                    nullptr);
            ::_exit(127);
        }
        ::close(out[1]);
        std::string text;
        char buffer[256];
        for (ssize_t n; (n = ::read(out[0], buffer, sizeof buffer)) > 0;) text.append(buffer, size_t(n));
        ::close(out[0]);
        int status = 0;
        ::waitpid(child, &status, 0);
        Outcome outcome;
        outcome.killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
        EXPECT_TRUE(outcome.killed || (WIFEXITED(status) && WEXITSTATUS(status) == 0)) << text;
        for (const char phase : text)
            if (phase >= 'A' && phase <= 'D' && outcome.phases.size() == size_t(phase - 'A'))
                outcome.phases += phase;
        return outcome;
    }

    // The state that a file holds: 1, 2 or 3; 0 where it is none of them.
    static int stateIn(const std::string& path) {
        const Result<Document> loaded = loadDocument(path);
        if (!loaded) return 0;
        const auto bytes = testing::bytesOf(*loaded);
        for (const int state : {1, 2, 3}) {
            // As it comes out of a file: rounded.
            Document document = painted(.1f * float(state));
            const auto encoded = testing::bytesOf(document);
            if (bytes == testing::bytesOf(decodeDocument(encoded).value())) return state;
        }
        return 0;
    }
};

TEST_F(CrashTest, NoWriteIsTheWrongOneToDieAt) {
    int kills = 0;
    for (int at = 1;; ++at) {
        SCOPED_TRACE(at);
        std::filesystem::remove_all(mFolder / "recovery");
        Document old = painted(.1f);
        ASSERT_TRUE(saveDocument(old, this->at("a.tessera")));
        const Outcome outcome = run(at);
        if (!outcome.killed) {
            EXPECT_EQ(outcome.phases, "ABCD");
            break;
        }
        ++kills;
        const int inFile = stateIn(this->at("a.tessera"));
        EXPECT_TRUE(inFile == 1 || inFile == 3) << "neither the old nor the new document is in the file";
        RecoveryStore store(QString::fromStdString(this->at("recovery")));
        const auto left = store.leftBehind();
        ASSERT_LE(left.size(), 1u);
        const int recovered = left.empty() ? 0 : stateIn(left[0]->dataPath().toStdString());
        EXPECT_TRUE(left.empty() || recovered == 2 || recovered == 3) << "a manifest leads to no document";
        const size_t phases = outcome.phases.size();
        const int latest = std::max(inFile, recovered);
        // What has been written once is never lost again.
        EXPECT_TRUE(phases < 1 || latest >= 2);
        EXPECT_TRUE(phases < 2 || latest == 3);
        EXPECT_TRUE(phases < 3 || inFile == 3);
        EXPECT_TRUE(phases < 1 || phases > 2 || !left.empty());
    }
    // Data, manifest and old data, twice; file; manifest and data: if fewer were counted, the functions above
    // would not be in the way.
    EXPECT_GE(kills, 15);
    std::printf("killed at each of %d writes\n", kills);
}

// The checker sees a loss: a file that is written in place is neither the old nor the new one.
TEST_F(CrashTest, ATornFileIsSeen) {
    Document document = painted(.3f);
    const std::vector<uint8_t> bytes = encodeDocument(document).value();
    std::ofstream(at("a.tessera"), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size() / 2));
    EXPECT_EQ(stateIn(at("a.tessera")), 0);
}

}  // namespace
}  // namespace tessera
