// A window to which tests send real events, and a picture for it to work on.
#pragma once

#include <gtest/gtest.h>

#include <QApplication>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QMessageBox>
#include <QMimeData>
#include <QPainter>
#include <QPushButton>
#include <QTemporaryDir>
#include <QTest>
#include <QTimer>
#include <QWheelEvent>
#include <cmath>
#include <functional>

#include "app/settings.h"
#include "ui/action_table.h"
#include "ui/application.h"
#include "ui/canvas_widget.h"
#include "ui/main_window.h"
#include "ui/message_bar.h"
#include "ui/vectorize_panel.h"

namespace tessera {

constexpr int kWaitMs = 120'000;
constexpr int kPatches = 60;

// A disk on a slope: one feature, and nothing that a few patches could not hold.
inline QImage disk(int width, int height) {
    QImage image(width, height, QImage::Format_RGB32);
    QPainter painter(&image);
    painter.setRenderHint(QPainter::Antialiasing);
    QLinearGradient slope(0, 0, width, height);
    slope.setColorAt(0, QColor(30, 60, 110));
    slope.setColorAt(1, QColor(90, 150, 190));
    painter.fillRect(image.rect(), slope);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(240, 180, 60));
    painter.drawEllipse(QPointF(width * .5, height * .5), height * .3, height * .3);
    return image;
}

class MainWindowTest : public ::testing::Test {
  protected:
    void SetUp() override {
        photo = folder.filePath("disk.png");
        ASSERT_TRUE(disk(160, 120).save(photo));
        Settings().setVectorizeOnOpen(false);  // each test says when
        window = std::make_unique<MainWindow>();
        window->resize(1000, 700);
        window->show();
        // Keys go to the active window; without a window manager nobody else makes it so.
        window->activateWindow();
        ASSERT_TRUE(QTest::qWaitForWindowActive(window.get()));
        canvas().setFocus();
    }

    CanvasWidget& canvas() { return window->canvas(); }
    Workspace& workspace() { return window->workspace(); }
    DocumentSession* session() { return workspace().session(); }
    QAction* action(ActionId id) { return window->actions()[id]; }

    bool idle() {
        return QTest::qWaitFor([&] { return !workspace().currentJob(); }, kWaitMs);
    }
    bool settled() {
        return QTest::qWaitFor([&] { return canvas().settled(); }, kWaitMs);
    }
    void openPhoto() {
        window->open(photo);
        ASSERT_TRUE(idle());
        ASSERT_NE(session(), nullptr) << window->messages().text().toStdString();
    }
    void vectorize() {
        window->panel().setPatches(kPatches);
        QTest::keyClick(&canvas(), Qt::Key_Return, Qt::ControlModifier);
        ASSERT_TRUE(workspace().running(JobKind::Vectorize));
        ASSERT_TRUE(idle());
        ASSERT_TRUE(session()->hasMesh()) << window->messages().text().toStdString();
        ASSERT_TRUE(settled());
    }
    QImage grab() { return canvas().grab().toImage(); }
    void wheel(QPointF at, int notches, Qt::KeyboardModifiers modifiers) {
        QWheelEvent event(at, canvas().mapToGlobal(at), {}, {0, 120 * notches}, Qt::NoButton, modifiers,
                          Qt::NoScrollPhase, false);
        QApplication::sendEvent(&canvas(), &event);
    }
    void drop(const QString& path) {
        QMimeData data;
        data.setUrls({QUrl::fromLocalFile(path)});
        QDragEnterEvent enter({200, 200}, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
        QApplication::sendEvent(window.get(), &enter);
        ASSERT_TRUE(enter.isAccepted());
        QDropEvent event({200, 200}, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
        QApplication::sendEvent(window.get(), &event);
    }
    // Hands the next dialog of this type to `act`, once it is there.
    template <class Dialog>
    void whenAsked(std::function<void(Dialog&)> act) {
        auto* timer = new QTimer(window.get());
        QObject::connect(timer, &QTimer::timeout, timer, [timer, act = std::move(act)] {
            auto* dialog = qobject_cast<Dialog*>(QApplication::activeModalWidget());
            if (!dialog || !dialog->isVisible()) return;
            const auto run = act;
            timer->stop();
            timer->deleteLater();
            run(*dialog);
        });
        timer->start(20);
    }
    // Presses a button of the next question.
    void answer(QMessageBox::StandardButton button) {
        QTimer::singleShot(100, window.get(), [button] {
            auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
            ASSERT_NE(box, nullptr);
            QTest::mouseClick(box->button(button), Qt::LeftButton);
        });
    }

    QTemporaryDir folder;
    QString photo;
    std::unique_ptr<MainWindow> window;
};

// Mean difference of two pictures of the same size, 0..255.
inline double difference(const QImage& a, const QImage& b) {
    EXPECT_EQ(a.size(), b.size());
    double sum = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const QColor p = a.pixelColor(x, y), q = b.pixelColor(x, y);
            sum +=
                std::abs(p.red() - q.red()) + std::abs(p.green() - q.green()) + std::abs(p.blue() - q.blue());
        }
    return sum / (3. * a.width() * a.height());
}

// Runs the tests with settings and data of their own: those of the user are neither read nor changed.
inline int runWindowTests(int argc, char** argv) {
    ::testing::InitGoogleTest(&argc, argv);
    const QTemporaryDir home;
    for (const char* name : {"XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME", "XDG_STATE_HOME"})
        qputenv(name, home.path().toUtf8());
    QApplication application(argc, argv);
    setUpApplication(application);
    return RUN_ALL_TESTS();
}

}  // namespace tessera
