// The window: canvas, panel, bars and menus around one workspace. It asks and shows; the workspace does.
#pragma once

#include <QMainWindow>
#include <functional>

#include "app/settings.h"
#include "app/workspace.h"

class QDockWidget;
class QMenu;

namespace tessera {

class ActionTable;
class CanvasWidget;
class MessageBar;
class StatusBar;
class VectorizePanel;

class MainWindow : public QMainWindow {
    Q_OBJECT

  public:
    MainWindow();
    ~MainWindow() override;

    // Opens a file as if it had been chosen; asks first where changes would be lost.
    void open(const QString& path);
    // Vectorizes with the panel's settings, now or as soon as the file that is being opened is there.
    void vectorizeWhenOpen();
    // Saves to `path`, a .tessera file, without asking.
    void saveTo(const QString& path, std::function<void()> then = {});

    Workspace& workspace() { return mWorkspace; }
    CanvasWidget& canvas() { return *mCanvas; }
    MessageBar& messages() { return *mMessages; }
    StatusBar& status() { return *mStatus; }
    VectorizePanel& panel() { return *mPanel; }
    const ActionTable& actions() const { return *mActions; }

  protected:
    void closeEvent(QCloseEvent* event) override;
    void dragEnterEvent(QDragEnterEvent* event) override;
    void dropEvent(QDropEvent* event) override;

  private:
    void buildLayout();
    QWidget* makeWelcome();
    void connectActions();
    void connectWorkspace();
    void restoreWindow();
    void storeWindow();

    void chooseAndOpen();
    void save(std::function<void()> then = {});
    void chooseAndSave(std::function<void()> then = {});
    void chooseAndExport();
    // Runs `then` at once where nothing would be lost, else after asking and, perhaps, saving.
    void withChangesKept(std::function<void()> then);
    void startVectorize();
    void showAbout();

    void adoptSession();
    void showSession();
    void updateActions();
    void updateOverlays();
    void updateTitle();
    void fillRecentMenu();
    void setPanelsHidden(bool hidden);

    Settings mSettings;
    std::unique_ptr<ActionTable> mActions;
    CanvasWidget* mCanvas = nullptr;
    QWidget* mWelcome = nullptr;
    MessageBar* mMessages = nullptr;
    StatusBar* mStatus = nullptr;
    VectorizePanel* mPanel = nullptr;
    QDockWidget* mDock = nullptr;
    QMenu* mRecent = nullptr;
    bool mVectorizeWhenOpen = false;
    bool mClosing = false;
    Workspace mWorkspace;  // last: it goes first, with the jobs that report to the rest
};

}  // namespace tessera
