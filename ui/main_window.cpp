// See main_window.h. What asks for files is in main_window_files.cpp.
#include "ui/main_window.h"

#include <QApplication>
#include <QDockWidget>
#include <QFileInfo>
#include <QLabel>
#include <QMenuBar>
#include <QMessageBox>
#include <QPushButton>
#include <QScreen>
#include <QVBoxLayout>

#include "ui/action_table.h"
#include "ui/canvas_widget.h"
#include "ui/message_bar.h"
#include "ui/status_bar.h"
#include "ui/theme.h"
#include "ui/vectorize_panel.h"

namespace tessera {

namespace {

constexpr QSize kFirstSize(1320, 840);

}  // namespace

MainWindow::MainWindow() : mActions(std::make_unique<ActionTable>(this, mSettings)) {
    setAcceptDrops(true);
    setContextMenuPolicy(Qt::NoContextMenu);
    buildLayout();
    connectActions();
    connectWorkspace();
    restoreWindow();
    showSession();
    mCanvas->setFocus();
}

MainWindow::~MainWindow() {
    // The canvas must not look at a session that goes with the workspace before it.
    mCanvas->setSession(nullptr);
}

void MainWindow::buildLayout() {
    auto* centre = new QWidget;
    auto* column = new QVBoxLayout(centre);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(0);
    column->addWidget(mMessages = new MessageBar);
    column->addWidget(mCanvas = new CanvasWidget, 1);
    auto* middle = new QVBoxLayout(mCanvas);
    middle->addWidget(mWelcome = makeWelcome(), 0, Qt::AlignCenter);
    setCentralWidget(centre);

    mPanel = new VectorizePanel(mSettings, *mActions);
    mDock = new QDockWidget(tr("Vectorize"));
    mDock->setObjectName("vectorizeDock");
    mDock->setWidget(mPanel);
    mDock->setAllowedAreas(Qt::LeftDockWidgetArea | Qt::RightDockWidgetArea);
    mDock->setFeatures(QDockWidget::DockWidgetMovable);
    addDockWidget(Qt::RightDockWidgetArea, mDock);

    setStatusBar(mStatus = new StatusBar);
    mRecent = new QMenu(tr("Open &Recent"), this);
    mActions->fill(menuBar(), mRecent);
    connect(mRecent, &QMenu::aboutToShow, this, &MainWindow::fillRecentMenu);
}

QWidget* MainWindow::makeWelcome() {
    auto* welcome = new QWidget;
    auto* column = new QVBoxLayout(welcome);
    column->setSpacing(12);
    auto* icon = new QLabel;
    icon->setPixmap(windowIcon().pixmap(96, 96));
    icon->setAlignment(Qt::AlignCenter);
    auto* title = new QLabel(tr("Drop a photo here"));
    QFont large = title->font();
    large.setPointSizeF(large.pointSizeF() * 1.7);
    title->setFont(large);
    title->setAlignment(Qt::AlignCenter);
    auto* hint =
        new QLabel(tr("or open one; Tessera turns it into curved patches that stay sharp at any size."));
    hint->setProperty("role", "dim");
    hint->setAlignment(Qt::AlignCenter);
    auto* open = new QPushButton(tr("Open a Photo…"));
    open->setProperty("role", "primary");
    open->setMinimumHeight(36);
    open->setFocusPolicy(Qt::TabFocus);
    connect(open, &QPushButton::clicked, (*mActions)[ActionId::Open], &QAction::trigger);
    for (QWidget* widget : std::initializer_list<QWidget*>{icon, title, hint}) column->addWidget(widget);
    column->addSpacing(8);
    column->addWidget(open, 0, Qt::AlignCenter);
    return welcome;
}

void MainWindow::connectActions() {
    const ActionTable& a = *mActions;
    const auto on = [&](ActionId id, auto slot) { connect(a[id], &QAction::triggered, this, slot); };
    const auto onToggled = [&](ActionId id, auto slot) { connect(a[id], &QAction::toggled, this, slot); };
    on(ActionId::Open, [this] { chooseAndOpen(); });
    on(ActionId::Save, [this] { save(); });
    on(ActionId::SaveAs, [this] { chooseAndSave(); });
    on(ActionId::Export, [this] { chooseAndExport(); });
    on(ActionId::Quit, [this] { close(); });
    on(ActionId::Undo, [this] { mWorkspace.session()->history().undo(); });
    on(ActionId::Redo, [this] { mWorkspace.session()->history().redo(); });
    on(ActionId::ZoomIn, [this] { mCanvas->zoomStep(true); });
    on(ActionId::ZoomOut, [this] { mCanvas->zoomStep(false); });
    on(ActionId::ZoomFit, [this] { mCanvas->fit(); });
    on(ActionId::Zoom100, [this] { mCanvas->zoomTo(1); });
    on(ActionId::Vectorize, [this] { startVectorize(); });
    on(ActionId::Cancel, [this] { mWorkspace.cancel(); });
    on(ActionId::About, [this] { showAbout(); });
    for (const ActionId id : {ActionId::ShowFeatures, ActionId::ShowEdges, ActionId::ShowControlPoints})
        onToggled(id, [this] { updateOverlays(); });
    onToggled(ActionId::ShowOriginal, [this](bool shown) { mCanvas->setShowOriginal(shown); });
    onToggled(ActionId::HidePanels, [this](bool hidden) { setPanelsHidden(hidden); });
    onToggled(ActionId::FullScreen, [this](bool full) { full ? showFullScreen() : showNormal(); });
    onToggled(ActionId::DarkTheme, [this](bool dark) {
        const Theme theme = dark ? Theme::Dark : Theme::Light;
        mSettings.setTheme(theme);
        applyTheme(*qApp, theme);
        mCanvas->setTheme(theme);
    });
    // Tab moves the focus within the panel; on the canvas, where there is nothing to move to, it hides the
    // panel.
    QAction* hide = a[ActionId::HidePanels];
    removeAction(hide);
    hide->setShortcutContext(Qt::WidgetShortcut);
    mCanvas->addAction(hide);
    a[ActionId::DarkTheme]->setChecked(mSettings.theme() == Theme::Dark);
    mCanvas->setTheme(mSettings.theme());
}

void MainWindow::connectWorkspace() {
    connect(&mWorkspace, &Workspace::sessionChanged, this, &MainWindow::adoptSession);
    connect(&mWorkspace, &Workspace::said, mMessages, &MessageBar::show);
    connect(&mWorkspace, &Workspace::fileUsed, this, [this](const QString& path) {
        mSettings.addRecentFile(path);
        mSettings.setFolder(QFileInfo(path).absolutePath());
    });
    connect(&mWorkspace, &Workspace::jobChanged, this, [this] {
        mStatus->showJob(mWorkspace.currentJob());
        updateActions();
    });
    connect(mStatus, &StatusBar::cancelRequested, &mWorkspace, &Workspace::cancel);
    connect(mStatus, &StatusBar::zoomClicked, this, [this] { mCanvas->zoomTo(1); });
    connect(mCanvas, &CanvasWidget::viewChanged, this,
            [this] { mStatus->showZoom(mCanvas->view().scale()); });
    connect(mCanvas, &CanvasWidget::cursorMoved, mStatus, &StatusBar::showCursor);
    connect(mPanel, &VectorizePanel::editingDone, this, [this] { mCanvas->setFocus(); });
}

void MainWindow::adoptSession() {
    DocumentSession* session = mWorkspace.session();
    if (!session) {
        mCanvas->setSession(nullptr);
        return showSession();
    }
    // This window shows one document; whether the one before may go was asked before.
    const QList<DocumentSession*> open = mWorkspace.sessions();
    for (DocumentSession* other : open)
        if (other != session)
            mWorkspace.close(other, [](auto&) { return CloseAnswer{CloseAnswer::Kind::Discard}; });
    connect(&session->history(), &History::changed, this, &MainWindow::updateActions);
    mMessages->hide();
    (*mActions)[ActionId::ShowOriginal]->setChecked(false);
    mCanvas->setSession(session);
    connect(session, &DocumentSession::changed, this, &MainWindow::showSession);
    if (session->hasMesh()) mPanel->showSettings(session->document().settings);
    showSession();
    mCanvas->setFocus();
    const bool vectorize = !session->hasMesh() && (mVectorizeWhenOpen || mSettings.vectorizeOnOpen());
    mVectorizeWhenOpen = false;
    if (vectorize) startVectorize();
}

void MainWindow::showSession() {
    const DocumentSession* session = mWorkspace.session();
    mWelcome->setVisible(!session);
    mStatus->showCounts(session, mCanvas->featureCount());
    mStatus->showZoom(mCanvas->view().scale());
    mPanel->showSession(session, mCanvas->featureCount());
    updateActions();
    updateTitle();
}

void MainWindow::updateActions() {
    const DocumentSession* session = mWorkspace.session();
    const bool hasMesh = session && session->hasMesh();
    const ActionTable& a = *mActions;
    const bool saving = mWorkspace.running(JobKind::Save);
    a[ActionId::Save]->setEnabled(hasMesh && !saving);
    a[ActionId::SaveAs]->setEnabled(hasMesh && !saving);
    a[ActionId::Export]->setEnabled(hasMesh && !mWorkspace.running(JobKind::Export));
    a[ActionId::Vectorize]->setEnabled(mWorkspace.canVectorize());
    a[ActionId::Cancel]->setEnabled(mWorkspace.currentJob());
    for (const ActionId id : {ActionId::ZoomIn, ActionId::ZoomOut, ActionId::ZoomFit, ActionId::Zoom100})
        a[id]->setEnabled(session);
    for (const ActionId id : {ActionId::ShowFeatures, ActionId::ShowEdges, ActionId::ShowControlPoints})
        a[id]->setEnabled(hasMesh);
    a[ActionId::ShowOriginal]->setEnabled(hasMesh && session->photo().pyramid);
    const History* history = session ? &session->history() : nullptr;
    a[ActionId::Undo]->setEnabled(history && history->canUndo());
    a[ActionId::Redo]->setEnabled(history && history->canRedo());
    a[ActionId::Undo]->setText(tr("&Undo %1").arg(history ? history->undoText() : QString()).trimmed());
    a[ActionId::Redo]->setText(tr("&Redo %1").arg(history ? history->redoText() : QString()).trimmed());
}

void MainWindow::updateOverlays() {
    const ActionTable& a = *mActions;
    mCanvas->setOverlays({.features = a[ActionId::ShowFeatures]->isChecked(),
                          .edges = a[ActionId::ShowEdges]->isChecked(),
                          .controlPoints = a[ActionId::ShowControlPoints]->isChecked()});
}

void MainWindow::updateTitle() {
    const DocumentSession* session = mWorkspace.session();
    setWindowTitle(session ? tr("%1[*] — Tessera").arg(session->displayName()) : tr("Tessera"));
    setWindowModified(session && session->modified());
}

void MainWindow::setPanelsHidden(bool hidden) {
    mDock->setVisible(!hidden);
}

void MainWindow::startVectorize() {
    mMessages->hide();
    mCanvas->setFocus();
    mWorkspace.vectorize(mPanel->settings(mWorkspace.session()));
}

void MainWindow::showAbout() {
    QMessageBox::about(
        this, tr("About Tessera"),
        tr("<h3>Tessera %1</h3><p>Turns photographs into vector images made of curved triangular "
           "patches, and lets you recolour and reshape them.</p>")
            .arg(QApplication::applicationVersion()));
}

void MainWindow::restoreWindow() {
    if (!restoreGeometry(mSettings.blob("geometry"))) resize(kFirstSize.boundedTo(screen()->availableSize()));
    restoreState(mSettings.blob("state"));
    const QByteArray shown = mSettings.blob("overlays");
    const ActionTable& a = *mActions;
    a[ActionId::ShowFeatures]->setChecked(shown.contains('f'));
    a[ActionId::ShowEdges]->setChecked(shown.contains('e'));
    a[ActionId::ShowControlPoints]->setChecked(shown.contains('c'));
    mDock->show();
}

void MainWindow::storeWindow() {
    mSettings.setBlob("geometry", saveGeometry());
    mSettings.setBlob("state", saveState());
    const ActionTable& a = *mActions;
    QByteArray shown;
    if (a[ActionId::ShowFeatures]->isChecked()) shown += 'f';
    if (a[ActionId::ShowEdges]->isChecked()) shown += 'e';
    if (a[ActionId::ShowControlPoints]->isChecked()) shown += 'c';
    mSettings.setBlob("overlays", shown);
}

}  // namespace tessera
