// Runs the tests of one program with an event loop, and without the settings and folders of whoever runs
// them.
#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QTemporaryDir>

int main(int argc, char** argv) {
    ::testing::InitGoogleTest(&argc, argv);
    const QTemporaryDir home;
    qputenv("XDG_CONFIG_HOME", home.filePath("config").toUtf8());
    qputenv("XDG_DATA_HOME", home.filePath("data").toUtf8());
    const QCoreApplication application(argc, argv);
    return RUN_ALL_TESTS();
}
