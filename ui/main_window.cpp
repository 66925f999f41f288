// See main_window.h. How it is put together is in main_window_layout.cpp, what asks for files in
// main_window_files.cpp.
#include "ui/main_window.h"

#include <QApplication>
#include <QFileInfo>
#include <QMenu>
#include <QMessageBox>
#include <QTabBar>
#include <QWindow>
#include <utility>

#include "app/selection_actions.h"
#include "ui/action_table.h"
#include "ui/canvas_keys.h"
#include "ui/canvas_widget.h"
#include "ui/conversions.h"
#include "ui/dialogs/cheat_sheet.h"
#include "ui/dialogs/preferences_dialog.h"
#include "ui/dialogs/recovery_dialog.h"
#include "ui/gl_drawer.h"
#include "ui/message_bar.h"
#include "ui/opening_card.h"
#include "ui/panels/history_panel.h"
#include "ui/panels/navigator.h"
#include "ui/panels/palette_panel.h"
#include "ui/panels/recolour_panel.h"
#include "ui/panels/selection_panel.h"
#include "ui/ruler.h"
#include "ui/session_actions.h"
#include "ui/start_page.h"
#include "ui/status_bar.h"
#include "ui/theme.h"
#include "ui/tool_bars.h"
#include "ui/vectorize_panel.h"

namespace tessera {

namespace {

constexpr double kBrushStep = 1.2;
constexpr double kLeastBrushPx = .5, kMostBrushPx = 2000;

size_t featureCount(const PatchMesh& mesh) {
    size_t count = 0;
    mesh.forEachEdge([&](EdgeId e) { count += mesh.curve(e).feature ? 1 : 0; });
    return count;
}

}  // namespace

MainWindow::MainWindow()
    : mSwatches(SwatchStore::defaultPath()),
      mActions(std::make_unique<ActionTable>(this, mSettings)),
      mDrafts(mWorkspace),
      mAutosave(mWorkspace, mRecovery) {
    setAcceptDrops(true);
    setContextMenuPolicy(Qt::NoContextMenu);
    buildLayout();
    connectActions();
    connectViewActions();
    connectWorkspace();
    connectCanvas();
    connectPanels();
    chooseRenderer();
    restoreWindow();
    applyBehaviour();
    showSession();
    mCanvas->setFocus();
}

MainWindow::~MainWindow() {
    // Nothing must look at a session that goes with the workspace, which goes before the widgets.
    mWorkspace.disconnect(this);
    attach(nullptr);
}

void MainWindow::connectActions() {
    const ActionTable& a = *mActions;
    const auto on = [&](ActionId id, auto slot) { connect(a[id], &QAction::triggered, this, slot); };
    on(ActionId::New, [this] { mWorkspace.setCurrent(nullptr); });
    on(ActionId::Open, [this] { chooseAndOpen(); });
    on(ActionId::Paste, [this] { paste(); });
    on(ActionId::Copy, [this] { copy(); });
    on(ActionId::Close, [this] { closeSession(mWorkspace.session()); });
    on(ActionId::Save, [this] { save(); });
    on(ActionId::SaveAs, [this] { chooseAndSave(); });
    on(ActionId::Export, [this] { chooseAndExport(); });
    on(ActionId::ExportAgain, [this] { mWorkspace.exportAgain(); });
    on(ActionId::Relink, [this] { chooseAndRelink(); });
    on(ActionId::Preferences, [this] { showPreferences(); });
    on(ActionId::Quit, [this] { close(); });
    on(ActionId::Undo, [this] { mWorkspace.session()->history().undo(); });
    on(ActionId::Redo, [this] { mWorkspace.session()->history().redo(); });
    on(ActionId::Vectorize, [this] { startVectorize(); });
    on(ActionId::Cancel, [this] { mWorkspace.cancel(); });
    on(ActionId::LargerBrush, [this] { changeBrush(kBrushStep); });
    on(ActionId::SmallerBrush, [this] { changeBrush(1 / kBrushStep); });
    on(ActionId::CheatSheet, [this] { showCheatSheet(); });
    on(ActionId::About, [this] { showAbout(); });
    connectSessionActions(a, this, mWorkspace, mTools, [this](const QString& text) { say(text); });
}

void MainWindow::connectViewActions() {
    const ActionTable& a = *mActions;
    const auto on = [&](ActionId id, auto slot) { connect(a[id], &QAction::triggered, this, slot); };
    const auto onToggled = [&](ActionId id, auto slot) { connect(a[id], &QAction::toggled, this, slot); };
    on(ActionId::ZoomIn, [this] { mCanvas->zoomStep(true); });
    on(ActionId::ZoomOut, [this] { mCanvas->zoomStep(false); });
    on(ActionId::ZoomFit, [this] { mCanvas->fit(); });
    on(ActionId::Zoom100, [this] { mCanvas->zoomTo(1); });
    on(ActionId::FitSelection, [this] { fitSelection(); });
    on(ActionId::PreviousZoom, [this] { mCanvas->previousZoom(); });
    on(ActionId::OutlineView, [this] { cycleOutlineView(); });
    for (const ActionId id : {ActionId::ShowFeatures, ActionId::ShowEdges, ActionId::ShowControlPoints,
                              ActionId::ShowCentres, ActionId::ShowBlur, ActionId::ShowImportance})
        onToggled(id, [this] { updateOverlays(); });
    // A feature has one colour at a time.
    const auto excludes = [&](ActionId id, ActionId other) {
        onToggled(id, [action = a[other]](bool shown) {
            if (shown) action->setChecked(false);
        });
    };
    excludes(ActionId::ShowBlur, ActionId::ShowImportance);
    excludes(ActionId::ShowImportance, ActionId::ShowBlur);
    onToggled(ActionId::ShowHeatMap, [this](bool shown) { mHeatMap.setWanted(shown); });
    onToggled(ActionId::ShowOriginal, [this](bool shown) { mCanvas->setShowOriginal(shown); });
    onToggled(ActionId::Split, [this](bool split) { mCanvas->setSplit(split); });
    onToggled(ActionId::XRay, [this](bool shown) { mCanvas->setXRay(shown); });
    onToggled(ActionId::Rulers, [this](bool shown) {
        for (QWidget* widget : {static_cast<QWidget*>(mTopRuler), static_cast<QWidget*>(mLeftRuler), mCorner})
            widget->setVisible(shown);
    });
    on(ActionId::ResetPanels, [this] { resetPanels(); });
    onToggled(ActionId::HidePanels, [this](bool hidden) { setPanelsHidden(hidden); });
    onToggled(ActionId::FullScreen, [this](bool full) {
        // Alone: a maximized window is maximized again afterwards.
        setWindowState(windowState().setFlag(Qt::WindowFullScreen, full));
    });
    // Tab moves the focus within the panel; on the canvas, where there is nothing to move to, it hides the
    // panels.
    QAction* hide = a[ActionId::HidePanels];
    removeAction(hide);
    hide->setShortcutContext(Qt::WidgetShortcut);
    mCanvas->addAction(hide);
    emit a[ActionId::Rulers]->toggled(false);
    fillZoomMenu();
}

void MainWindow::fillZoomMenu() {
    QMenu& menu = mStatus->zoomMenu();
    menu.addAction((*mActions)[ActionId::ZoomFit]);
    menu.addAction((*mActions)[ActionId::FitSelection]);
    menu.addSeparator();
    for (const double scale : {.25, .5, 1., 2., 4., 8.}) {
        if (scale == 1)
            menu.addAction((*mActions)[ActionId::Zoom100]);
        else
            connect(menu.addAction(zoomText(scale)), &QAction::triggered, this,
                    [this, scale] { mCanvas->zoomTo(scale); });
    }
}

void MainWindow::connectWorkspace() {
    connect(&mWorkspace, &Workspace::sessionChanged, this, &MainWindow::adoptSession);
    for (const auto signal : {&Workspace::sessionAdded, &Workspace::sessionClosed, &Workspace::saved})
        connect(&mWorkspace, signal, this, &MainWindow::showTabs, Qt::QueuedConnection);
    connect(&mWorkspace, &Workspace::sessionAdded, this,
            [this](DocumentSession* session) { welcome(*session); });
    connect(&mWorkspace, &Workspace::said, mMessages, &MessageBar::show);
    connect(&mWorkspace, &Workspace::sessionClosed, mMessages, &MessageBar::forget);
    connect(&mWorkspace, &Workspace::fileUsed, this, [this](const QString& path) {
        mSettings.addRecentFile(path);
        mSettings.setFolder(QFileInfo(path).absolutePath());
        mStart->setRecentFiles(mSettings.recentFiles());
    });
    connect(&mWorkspace, &Workspace::jobChanged, this, [this] {
        mStatus->showJob(mWorkspace.currentJob());
        // The file that it was wished for could not be opened.
        if (!mWorkspace.running(JobKind::Open)) mVectorizeWhenOpen = false;
        showBeginning();
        updateActions();
        mentionWhenOpen();
    });
    connect(mOpening, &OpeningCard::cancelRequested, &mWorkspace, &Workspace::cancel);
    connect(mStatus, &StatusBar::cancelRequested, &mWorkspace, &Workspace::cancel);
    connect(mTabs, &QTabBar::currentChanged, this, [this](int tab) {
        if (tab >= 0) mWorkspace.setCurrent(mWorkspace.sessions().value(tab));
    });
    connect(mTabs, &QTabBar::tabCloseRequested, this,
            [this](int tab) { closeSession(mWorkspace.sessions().value(tab)); });
    connect(mTabs, &QTabBar::tabMoved, &mWorkspace, &Workspace::moveSession);
    // The tab of the start page stays behind those of documents.
    connect(mTabs, &QTabBar::tabMoved, this, &MainWindow::showTabs, Qt::QueuedConnection);
}

void MainWindow::connectCanvas() {
    mCanvas->setTools(&mTools, *mActions);
    auto* keys = new CanvasKeys(*this, *mCanvas, *mActions);
    keys->setParent(this);
    connect(keys, &CanvasKeys::heldChanged, mCanvas, [this](ActionId id, bool down) {
        id == ActionId::Pan ? mCanvas->setPanHeld(down) : mCanvas->setPeeking(down);
    });
    connect(mCanvas, &CanvasWidget::viewChanged, this, &MainWindow::showView);
    connect(mCanvas, &CanvasWidget::cursorMoved, mStatus, &StatusBar::showCursor);
    connect(mCanvas, &CanvasWidget::cursorMoved, this, [this](std::optional<QPointF> image) {
        mTopRuler->setPointer(image ? std::optional(image->x()) : std::nullopt);
        mLeftRuler->setPointer(image ? std::optional(image->y()) : std::nullopt);
    });
    connect(mCanvas, &CanvasWidget::overviewChanged, this,
            [this] { mNavigator->setPicture(mCanvas->overviewImage()); });
    connect(mCanvas, &CanvasWidget::contextMenuWanted, this, &MainWindow::showContextMenu);
    connect(&mHeatMap, &HeatMap::ready, mCanvas, &CanvasWidget::setHeatMap);
    connect(&mTools, &ToolManager::said, this, &MainWindow::say);
    // Keys of a tool are for the canvas, wherever the pointer took the tool up.
    connect(&mTools, &ToolManager::toolChanged, mCanvas, [this] {
        mCanvas->setFocus();
        updateOverlays();
    });
}

void MainWindow::chooseRenderer() {
    CanvasRenderer renderer = makeCanvasRenderer(qEnvironmentVariable("TESSERA_RENDERER") == "gl");
    mStatus->showRenderer(renderer.drawer != nullptr, renderer.text);
    mCanvas->setDrawer(std::move(renderer.drawer));
    connect(mCanvas, &CanvasWidget::drawerLost, this, [this](const QString& reason) {
        mStatus->showRenderer(false, tr("Drawn by the processor: %1").arg(reason));
    });
}

void MainWindow::connectPanels() {
    connect(mPanel, &VectorizePanel::draftWanted, this,
            [this] { mDrafts.want(mPanel->settings(mWorkspace.session())); });
    connect(mPanel, &VectorizePanel::draftDropped, &mDrafts, &DraftPreview::drop);
    connect(mCanvas, &CanvasWidget::draftLeft, this, &MainWindow::leaveDraft);
    connect(mCanvas, &CanvasWidget::draftPressed, this, &MainWindow::explainDraft);
    connect(&mDrafts, &DraftPreview::changed, this, &MainWindow::showDraft);
    mTools.setFinish([this](std::shared_ptr<EditSession> gesture, ElementEdit edit, EditThen then) {
        mWorkspace.finish(std::move(gesture), std::move(edit), std::move(then));
    });
    mRecolour->setToolOptions(mTools);
    mPalette->setToolOptions(mTools);
    mSelection->setToolOptions(mTools);
    mSelection->showTipsOf(*mActions);
    connect(mRecolour, &RecolourPanel::said, this, &MainWindow::say);
    connect(mPalette, &PalettePanel::said, this, &MainWindow::say);
    connect(mSelection, &SelectionPanel::said, this, &MainWindow::say);
    connect(mPalette, &PalettePanel::highlighted, mCanvas, &CanvasWidget::setHighlight);
    connect(mNavigator, &Navigator::moveRequested, mCanvas, &CanvasWidget::centreOn);
    connect(mNavigator, &Navigator::zoomRequested, mCanvas, &CanvasWidget::zoomOnTo);
    connect(mRecent, &QMenu::aboutToShow, this, &MainWindow::fillRecentMenu);
    mStart->setRecentFiles(mSettings.recentFiles());
    connect(mStart, &StartPage::openRequested, this, &MainWindow::open);
    connect(mStart, &StartPage::openDialogRequested, this, [this] { chooseAndOpen(); });
    connect(mStart, &StartPage::pasteRequested, this, [this] { paste(); });
    connect(mStart, &StartPage::sampleRequested, this, [this] {
        const QString sample = StartPage::sampleFile();
        if (sample.isEmpty()) return say(tr("The sample picture could not be copied to the cache folder."));
        open(sample);
    });
    connect(mStart, &StartPage::clearRecentRequested, this, [this] {
        mSettings.clearRecentFiles();
        mStart->setRecentFiles({});
    });
}

void MainWindow::adoptSession() {
    DocumentSession* session = mWorkspace.session();
    mMessages->setDocument(session);
    for (const ActionId id : {ActionId::ShowOriginal, ActionId::ShowHeatMap})
        (*mActions)[id]->setChecked(false);
    attach(session);
    mNavigator->setPicture(mCanvas->overviewImage());
    if (session && session->hasMesh()) mPanel->showSettings(session->document().settings);
    showTabs();
    showSession();
    mCanvas->setFocus();
}

void MainWindow::attach(DocumentSession* session) {
    mTools.setSession(session);
    mCanvas->setSession(session);
    mHeatMap.setSession(session);
    mRecolour->setSession(session);
    mPalette->setSession(session);
    mSelection->setSession(session);
    mHistory->setSession(session);
    mDrafts.setSession(session);
}

void MainWindow::welcome(DocumentSession& session) {
    connect(&session, &DocumentSession::changed, this, [this, &session](const Change& change) {
        if (change.preview) return;
        showTabs();
        if (&session == mWorkspace.session()) showSession();
    });
    connect(&session, &DocumentSession::editingChanged, this, &MainWindow::updateActions);
    connect(&session.history(), &History::changed, this, &MainWindow::updateActions);
    connect(&session.selection(), &Selection::changed, this, &MainWindow::updateSelectionActions);
    const bool wanted = std::exchange(mVectorizeWhenOpen, false) || mSettings.vectorizeOnOpen();
    if (wanted && !session.hasMesh()) startVectorize();
}

void MainWindow::showSession() {
    showBeginning();
    showFigures();
    showView();
    updateActions();
    updateTitle();
}

void MainWindow::showFigures() {
    const DocumentSession* session = mWorkspace.session();
    const size_t features = session ? featureCount(session->document().mesh) : 0;
    const auto draft = draftPatches();
    mStatus->showCounts(session, features, draft);
    mPanel->showSession(session, features, draft);
}

std::optional<size_t> MainWindow::draftPatches() const {
    const auto& draft = mDrafts.mesh();
    return draft ? std::optional(draft->patchCount()) : std::nullopt;
}

void MainWindow::showBeginning() {
    const bool nothing = !mWorkspace.session();
    const Job* job = nothing ? mWorkspace.running(JobKind::Open) : nullptr;
    mOpening->showJob(job);
    mStart->setVisible(nothing && !job);
}

void MainWindow::showTabs() {
    const QSignalBlocker quiet(mTabs);
    const auto& sessions = mWorkspace.sessions();
    // The start page has a tab while there are documents to go back to.
    const bool startTab = !mWorkspace.session() && !sessions.isEmpty();
    const qsizetype count = sessions.size() + (startTab ? 1 : 0);
    while (mTabs->count() > count) mTabs->removeTab(mTabs->count() - 1);
    while (mTabs->count() < count) mTabs->addTab({});
    for (int i = 0; i < sessions.size(); ++i) {
        const DocumentSession* session = sessions[i];
        mTabs->setTabText(i, session->displayName() + (session->modified() ? " •" : ""));
        mTabs->setTabToolTip(i, session->path().isEmpty() ? session->photoPath() : session->path());
    }
    if (startTab) {
        mTabs->setTabText(mTabs->count() - 1, tr("New"));
        mTabs->setTabToolTip(mTabs->count() - 1, {});
    }
    mTabs->setCurrentIndex(startTab ? mTabs->count() - 1 : int(sessions.indexOf(mWorkspace.session())));
    mTabs->setVisible(count > 1);
}

void MainWindow::showView() {
    const double scale = mCanvas->view().scale();
    mTopRuler->setView(mCanvas->view());
    mLeftRuler->setView(mCanvas->view());
    const DocumentSession* session = mWorkspace.session();
    mStatus->showZoom(session ? std::optional(scale) : std::nullopt);
    mNavigator->setScale(scale);
    mNavigator->setVisibleRect(mCanvas->visiblePart(),
                               session ? QSizeF(session->width(), session->height()) : QSizeF());
}

void MainWindow::updateActions() {
    const DocumentSession* session = mWorkspace.session();
    const bool hasMesh = session && session->hasMesh();
    const bool hasPhoto = session && session->photo().pyramid;
    const ActionTable& a = *mActions;
    const auto enable = [&](std::initializer_list<ActionId> ids, bool on) {
        for (const ActionId id : ids) a[id]->setEnabled(on);
    };
    enable({ActionId::Save, ActionId::SaveAs}, hasMesh && !mWorkspace.running(JobKind::Save));
    enable({ActionId::Export}, hasMesh && !mWorkspace.running(JobKind::Export));
    enable({ActionId::ExportAgain}, mWorkspace.canExportAgain());
    enable({ActionId::Vectorize}, mWorkspace.canVectorize());
    enable({ActionId::Cancel}, mWorkspace.currentJob());
    enable({ActionId::New}, session);
    enable({ActionId::Close}, !mWorkspace.sessions().isEmpty());
    enable(
        {ActionId::ZoomIn, ActionId::ZoomOut, ActionId::ZoomFit, ActionId::Zoom100, ActionId::PreviousZoom},
        session);
    enable({ActionId::ShowFeatures, ActionId::ShowEdges, ActionId::ShowControlPoints, ActionId::ShowCentres,
            ActionId::ShowBlur, ActionId::ShowImportance, ActionId::OutlineView, ActionId::Copy,
            ActionId::Relink},
           hasMesh);
    enable({ActionId::ShowOriginal, ActionId::Split, ActionId::XRay, ActionId::ShowHeatMap},
           hasMesh && hasPhoto);
    const History* history = session ? &session->history() : nullptr;
    const bool resting = session && !session->editing();
    enable({ActionId::Undo}, resting && history->canUndo());
    enable({ActionId::Redo}, resting && history->canRedo());
    a[ActionId::Undo]->setText(tr("&Undo %1").arg(history ? history->undoText() : QString()).trimmed());
    a[ActionId::Redo]->setText(tr("&Redo %1").arg(history ? history->redoText() : QString()).trimmed());
    for (int i = 0; i < int(ToolId::Count); ++i)
        a[actionOf(ToolId(i))]->setEnabled(session);  // also while its patches are still being made
    updateSelectionActions();
}

void MainWindow::updateSelectionActions() {
    const DocumentSession* session = mWorkspace.session();
    enableSessionActions(*mActions, session);
    (*mActions)[ActionId::FitSelection]->setEnabled(session && !session->selection().empty());
    mStatus->showSelection(session ? session->selection().patches().size() : 0);
}

void MainWindow::updateOverlays() {
    const ActionTable& a = *mActions;
    const FeatureTint tint = a[ActionId::ShowBlur]->isChecked()         ? FeatureTint::Blur
                             : a[ActionId::ShowImportance]->isChecked() ? FeatureTint::Importance
                                                                        : FeatureTint::Plain;
    // What can be taken hold of is seen.
    const bool shaping = mTools.tool() == ToolId::Direct, softening = mTools.tool() == ToolId::Blur;
    mCanvas->setOverlays(
        {.features = softening || tint != FeatureTint::Plain || a[ActionId::ShowFeatures]->isChecked(),
         .tint = tint,
         .edges = shaping || a[ActionId::ShowEdges]->isChecked(),
         .vertices = shaping,
         .controlPoints = a[ActionId::ShowControlPoints]->isChecked(),
         .centres = a[ActionId::ShowCentres]->isChecked()});
}

void MainWindow::cycleOutlineView() {
    const ActionTable& a = *mActions;
    const std::array steps{ActionId::ShowFeatures, ActionId::ShowEdges, ActionId::ShowControlPoints};
    for (const ActionId id : steps)
        if (!a[id]->isChecked()) return a[id]->setChecked(true);
    for (const ActionId id : steps) a[id]->setChecked(false);
}

void MainWindow::updateTitle() {
    const DocumentSession* session = mWorkspace.session();
    setWindowTitle(session ? tr("%1[*] — Tessera").arg(session->displayName()) : tr("Tessera"));
    setWindowModified(session && session->modified());
}

void MainWindow::startVectorize() {
    mMessages->clear();
    mCanvas->setFocus();
    mWorkspace.vectorize(mPanel->settings(mWorkspace.session()), mPanel->meanError());
}

void MainWindow::showDraft() {
    const auto& draft = mDrafts.mesh();
    mCanvas->setDraft(draft);
    if (!draft) mMessages->clear();
    mPanel->showDraft(draftPatches());
    showFigures();
}

void MainWindow::leaveDraft() {
    mDrafts.drop();
    // The number of patches goes back with the picture.
    const DocumentSession* session = mWorkspace.session();
    if (session && session->hasMesh()) mPanel->setPatches(session->document().settings.patches);
}

void MainWindow::explainDraft() {
    mMessages->show({.text = tr("This is a draft: apply it to edit it, or press Escape to go back."),
                     .actionText = tr("Apply"),
                     .action = [this] { startVectorize(); }});
}

void MainWindow::fitSelection() {
    const DocumentSession& session = *mWorkspace.session();
    const PatchMesh& mesh = session.document().mesh;
    QRectF area;
    for (const PatchId p : selectionsPatches(session)) area |= toRect(controlBounds(mesh, p));
    mCanvas->showRect(area);
}

void MainWindow::changeBrush(double factor) {
    ToolOptions options = mTools.options();
    options.brushRadiusPx = std::clamp(options.brushRadiusPx * factor, kLeastBrushPx, kMostBrushPx);
    mTools.setOptions(options);
}

void MainWindow::showContextMenu(QPoint at) {
    QMenu menu;
    const auto add = [&](std::initializer_list<ActionId> ids) {
        for (const ActionId id : ids)
            if ((*mActions)[id]->isEnabled()) menu.addAction((*mActions)[id]);
        menu.addSeparator();
    };
    add({ActionId::SelectAll, ActionId::SelectNone, ActionId::GrowSelection, ActionId::SelectSimilar});
    add({ActionId::Hide, ActionId::Lock, ActionId::CutOut, ActionId::FillIn});
    add({ActionId::SplitPatches, ActionId::SplitCurves, ActionId::MergeCurves, ActionId::SnapToFeature,
         ActionId::MarkFeature, ActionId::UnmarkFeature});
    add({ActionId::ResetColours, ActionId::ResetShape, ActionId::RefitColours});
    menu.exec(at);
}

void MainWindow::say(const QString& text) {
    mMessages->show({.text = text});
}

void MainWindow::applySettings() {
    applyTheme(*qApp, mSettings.theme());
    mActions->applyKeys(mSettings);
    applyBehaviour();
}

void MainWindow::applyBehaviour() {
    mCanvas->setTheme(mSettings.theme());
    mAutosave.setInterval(mSettings.autosaveSeconds());
    mWorkspace.setHistoryLimit(mSettings.historyBytes());
    Job::setThreadLimit(mSettings.threads());
}

void MainWindow::changeEvent(QEvent* event) {
    if (event->type() == QEvent::PaletteChange && mActions) mActions->tintIcons(palette());
    if (event->type() == QEvent::WindowStateChange && mActions)
        (*mActions)[ActionId::FullScreen]->setChecked(isFullScreen());
    if (event->type() == QEvent::ActivationChange && !isActiveWindow()) mTools.cancel();
    QMainWindow::changeEvent(event);
}

void MainWindow::showEvent(QShowEvent* event) {
    QMainWindow::showEvent(event);
    // Known from now on. Qt gives it on platforms that manage colours by surface, and else none.
    mCanvas->setScreenColours(windowHandle()->format().colorSpace());
}

void MainWindow::showPreferences() {
    PreferencesDialog dialog(mActions->keyRows(), mSettings, this);
    connect(&dialog, &PreferencesDialog::applied, this, &MainWindow::applySettings);
    dialog.exec();
}

void MainWindow::showCheatSheet() {
    CheatSheet(mActions->keyRows(), (*mActions)[ActionId::CheatSheet]->shortcut(), this).exec();
}

void MainWindow::findRecoverable() {
    for (const auto& slot : mRecovery.leftBehind())
        if (slot->info()) mRecoverable.push_back(slot);
}

void MainWindow::offerRecovery() {
    findRecoverable();
    askWhatToRecover();
}

void MainWindow::askWhatToRecover() {
    const auto found = std::exchange(mRecoverable, {});
    if (found.empty()) return;
    std::vector<RecoveryInfo> infos;
    for (const auto& slot : found) infos.push_back(slot->info().value_or(RecoveryInfo{}));
    RecoveryDialog dialog(infos, this);
    dialog.exec();
    for (const size_t i : dialog.chosen()) {
        if (dialog.answer() == RecoveryDialog::Answer::Recover) mAutosave.recover(found[i]);
        if (dialog.answer() == RecoveryDialog::Answer::Discard) found[i]->forget();
    }
}

void MainWindow::mentionRecovery() {
    findRecoverable();
    mMentionRecovery = !mRecoverable.empty();
    mentionWhenOpen();
}

void MainWindow::mentionWhenOpen() {
    if (mWorkspace.running(JobKind::Open) || !std::exchange(mMentionRecovery, false)) return;
    mMessages->show({.text = tr("Tessera ended before some changes were saved. They were autosaved."),
                     .actionText = tr("Recover…"),
                     .action = [this] { askWhatToRecover(); },
                     .keep = true});
}

void MainWindow::showAbout() {
    QMessageBox::about(
        this, tr("About Tessera"),
        tr("<h3>Tessera %1</h3><p>Turns photographs into vector images made of curved triangular "
           "patches, and lets you recolour and reshape them.</p>")
            .arg(QApplication::applicationVersion()));
}

}  // namespace tessera
