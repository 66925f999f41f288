// The window: canvas, bars, panels and menus around one workspace. It asks and shows; the workspace does.
#pragma once

#include <QMainWindow>
#include <functional>
#include <optional>

#include "app/autosave.h"
#include "app/draft_preview.h"
#include "app/heat_map.h"
#include "app/settings.h"
#include "app/swatch_store.h"
#include "app/tools/tool_manager.h"
#include "app/workspace.h"

class QDockWidget;
class QMenu;
class QTabBar;

namespace tessera {

class ActionTable;
class CanvasWidget;
class HistoryPanel;
class MessageBar;
class Navigator;
class OpeningCard;
class PalettePanel;
class RecolourPanel;
class Ruler;
class SelectionPanel;
class StartPage;
class StatusBar;
class ToolBar;
class ToolOptionsBar;
class VectorizePanel;

class MainWindow : public QMainWindow {
    Q_OBJECT

  public:
    MainWindow();
    ~MainWindow() override;

    // Opens a file as if it had been chosen.
    void open(const QString& path);
    // Vectorizes with the panel's settings, now or as soon as the file that is being opened is there.
    void vectorizeWhenOpen();
    // Saves to `path`, a .tessera file, without asking.
    void saveTo(const QString& path);
    // Offers the documents that a run before this one could not save, if there are any.
    void offerRecovery();
    // The same without being in the way: a word, once the file that is being opened is there.
    void mentionRecovery();

    Workspace& workspace() { return mWorkspace; }
    ToolManager& tools() { return mTools; }
    CanvasWidget& canvas() { return *mCanvas; }
    MessageBar& messages() { return *mMessages; }
    StatusBar& status() { return *mStatus; }
    VectorizePanel& panel() { return *mPanel; }
    QTabBar& tabs() { return *mTabs; }
    const ActionTable& actions() const { return *mActions; }

  protected:
    void closeEvent(QCloseEvent* event) override;
    void dragEnterEvent(QDragEnterEvent* event) override;
    void dropEvent(QDropEvent* event) override;
    void changeEvent(QEvent* event) override;
    void showEvent(QShowEvent* event) override;

  private:
    void findRecoverable();
    void askWhatToRecover();
    void mentionWhenOpen();
    // main_window_layout.cpp
    void buildLayout();
    QWidget* makeCentre();
    void makeDocks();
    // A panel, last in mDocks, that `shown` opens and closes, and that has its name.
    void addDock(const QString& name, QAction* shown, QWidget* content, bool scrolls);
    // All open, at the places that they have at first.
    void arrangeDocks();
    void resetPanels();
    // Towards the canvas, where the panel floats beside it, as if it were still docked, and is not dragged.
    void moveAside(QDockWidget* dock);
    void restoreWindow();
    void storeWindow();
    void setPanelsHidden(bool hidden);

    // main_window.cpp
    void connectActions();
    void connectViewActions();
    void fillZoomMenu();
    void connectWorkspace();
    void connectCanvas();
    void connectPanels();
    void chooseRenderer();
    void adoptSession();
    // To all that show or change a document; null for none.
    void attach(DocumentSession* session);
    void welcome(DocumentSession& session);
    void showSession();
    // What the canvas shows while no document is there.
    void showBeginning();
    void showTabs();
    void updateActions();
    void updateSelectionActions();
    void updateOverlays();
    void cycleOutlineView();
    void updateTitle();
    void showView();
    void startVectorize();
    void showFigures();
    std::optional<size_t> draftPatches() const;
    void showDraft();
    void leaveDraft();
    void explainDraft();
    void fitSelection();
    void changeBrush(double factor);
    void showContextMenu(QPoint at);
    void say(const QString& text);
    // What the preferences have written; applyBehaviour() is the part of it that start-up needs.
    void applySettings();
    void applyBehaviour();
    void showPreferences();
    void showCheatSheet();
    void showAbout();

    // main_window_files.cpp
    void chooseAndOpen();
    void paste();
    void copy();
    void save();
    void chooseAndSave();
    // A .tessera path; empty where the user chooses none.
    QString askForPath(const DocumentSession& session);
    void chooseAndExport();
    void chooseAndRelink();
    // Null is the start page in a tab of its own.
    void closeSession(DocumentSession* session);
    CloseQuestions closeQuestions();
    CloseAnswer askAboutChanges(DocumentSession& session);
    RunningAnswer askAboutWork(const QStringList& titles);
    void fillRecentMenu();

    Settings mSettings;
    SwatchStore mSwatches;
    std::unique_ptr<ActionTable> mActions;
    ToolManager mTools;
    HeatMap mHeatMap;
    CanvasWidget* mCanvas = nullptr;
    StartPage* mStart = nullptr;
    OpeningCard* mOpening = nullptr;
    QTabBar* mTabs = nullptr;
    Ruler* mTopRuler = nullptr;
    Ruler* mLeftRuler = nullptr;
    QWidget* mCorner = nullptr;  // between the rulers
    MessageBar* mMessages = nullptr;
    StatusBar* mStatus = nullptr;
    ToolBar* mToolBar = nullptr;
    ToolOptionsBar* mToolOptions = nullptr;
    VectorizePanel* mPanel = nullptr;
    RecolourPanel* mRecolour = nullptr;
    PalettePanel* mPalette = nullptr;
    SelectionPanel* mSelection = nullptr;
    HistoryPanel* mHistory = nullptr;
    Navigator* mNavigator = nullptr;
    QList<QDockWidget*> mDocks;
    QList<QDockWidget*> mHiddenDocks;  // by Hide Panels, in the order in which to show them again
    QMenu* mRecent = nullptr;
    bool mVectorizeWhenOpen = false;
    bool mMentionRecovery = false;
    std::vector<std::shared_ptr<RecoverySlot>> mRecoverable;  // whole documents of a run before this one
    bool mClosing = false;
    RecoveryStore mRecovery;
    Workspace mWorkspace;  // after all that its jobs report to: it goes before them
    DraftPreview mDrafts;
    Autosave mAutosave;
};

}  // namespace tessera
