// The part of the main window that puts it together and remembers where things were.
#include <QDockWidget>
#include <QGridLayout>
#include <QGuiApplication>
#include <QMenuBar>
#include <QScreen>
#include <QScrollArea>
#include <QScrollBar>
#include <QStackedLayout>
#include <QTabBar>
#include <QTimer>
#include <algorithm>

#include "ui/action_table.h"
#include "ui/canvas_widget.h"
#include "ui/main_window.h"
#include "ui/message_bar.h"
#include "ui/opening_card.h"
#include "ui/panels/history_panel.h"
#include "ui/panels/navigator.h"
#include "ui/panels/palette_panel.h"
#include "ui/panels/recolour_panel.h"
#include "ui/panels/selection_panel.h"
#include "ui/ruler.h"
#include "ui/start_page.h"
#include "ui/status_bar.h"
#include "ui/tool_bars.h"
#include "ui/vectorize_panel.h"

namespace tessera {

namespace {

constexpr QSize kFirstSize(1440, 900);
// What the panels need at least.
constexpr int kPanelWidthPx = 290;
constexpr int kFloatedAsidePx = 40;
constexpr int kFloatedMs = 150;  // a double click on the title is over by then
// Of what saveState() keeps: another number where docks have come or gone.
constexpr int kStateVersion = 3;

const std::array kRememberedToggles{
    ActionId::ShowFeatures, ActionId::ShowEdges,      ActionId::ShowControlPoints,
    ActionId::ShowBlur,     ActionId::ShowImportance, ActionId::ShowCentres,
    ActionId::Rulers};

}  // namespace

void MainWindow::buildLayout() {
    setCentralWidget(makeCentre());
    addToolBar(Qt::LeftToolBarArea, mToolBar = new ToolBar(*mActions, mTools));
    addToolBar(Qt::TopToolBarArea, mToolOptions = new ToolOptionsBar(*mActions, mTools));
    setTabPosition(Qt::RightDockWidgetArea, QTabWidget::North);
    makeDocks();
    setStatusBar(mStatus = new StatusBar);
    mRecent = new QMenu(tr("Open &Recent"), this);
    mActions->fill(menuBar(), mRecent);
}

QWidget* MainWindow::makeCentre() {
    auto* work = new QWidget;
    auto* grid = new QGridLayout(work);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setSpacing(0);
    grid->addWidget(mTabs = new QTabBar, 0, 0, 1, 2);
    grid->addWidget(mCorner = new QWidget, 1, 0);
    grid->addWidget(mTopRuler = new Ruler(Qt::Horizontal), 1, 1);
    grid->addWidget(mLeftRuler = new Ruler(Qt::Vertical), 2, 0);
    grid->addWidget(mCanvas = new CanvasWidget, 2, 1);
    // Over the canvas, so that the picture stays where it is when one has something to say.
    grid->addWidget(mMessages = new MessageBar, 2, 1, Qt::AlignTop);
    grid->setRowStretch(2, 1);
    grid->setColumnStretch(1, 1);
    mTabs->setObjectName("documents");
    mTabs->setTabsClosable(true);
    mTabs->setMovable(true);
    mTabs->setExpanding(false);
    mTabs->setDocumentMode(true);
    mTabs->setFocusPolicy(Qt::NoFocus);

    auto* over = new QGridLayout(mCanvas);
    over->setContentsMargins(0, 0, 0, 0);
    over->addWidget(mStart = new StartPage, 0, 0);
    over->addWidget(mOpening = new OpeningCard, 0, 0, Qt::AlignCenter);
    return work;
}

void MainWindow::makeDocks() {
    mPanel = new VectorizePanel(mSettings, *mActions);
    mRecolour = new RecolourPanel;
    mPalette = new PalettePanel(mSwatches);
    mSelection = new SelectionPanel;
    mHistory = new HistoryPanel;
    mNavigator = new Navigator;
    const auto add = [this](const QString& name, ActionId shown, QWidget* content, bool scrolls) {
        addDock(name, (*mActions)[shown], content, scrolls);
    };
    add("vectorizeDock", ActionId::ShowVectorizePanel, mPanel, true);
    add("recolourDock", ActionId::ShowRecolourPanel, mRecolour, true);
    add("paletteDock", ActionId::ShowPalettePanel, mPalette, true);
    add("selectionDock", ActionId::ShowSelectionPanel, mSelection, true);
    add("historyDock", ActionId::ShowHistoryPanel, mHistory, false);
    add("navigatorDock", ActionId::ShowNavigatorPanel, mNavigator, false);
    arrangeDocks();
}

void MainWindow::arrangeDocks() {
    for (QDockWidget* dock : mDocks) {
        dock->setFloating(false);
        removeDockWidget(dock);
        addDockWidget(Qt::RightDockWidgetArea, dock);
        dock->show();
    }
    // Two groups of three, one above the other.
    for (const int first : {0, 3})
        for (const int next : {first + 1, first + 2}) tabifyDockWidget(mDocks[next - 1], mDocks[next]);
    QDockWidget *const vectorize = mDocks.first(), *const navigator = mDocks.last();
    vectorize->raise();
    navigator->raise();
    resizeDocks({vectorize, navigator}, {3, 1}, Qt::Vertical);
}

void MainWindow::resetPanels() {
    (*mActions)[ActionId::HidePanels]->setChecked(false);
    arrangeDocks();
}

void MainWindow::moveAside(QDockWidget* dock) {
    // While the button is down the panel is being dragged; other presses are over by the time.
    const QPoint place = dock->pos();
    QTimer::singleShot(kFloatedMs, dock, [this, dock, place] {
        if (!dock->isFloating() || dock->pos() != place || QGuiApplication::mouseButtons()) return;
        const QRect canvas(mCanvas->mapToGlobal(QPoint(0, 0)), mCanvas->size()), panel = dock->geometry();
        if (panel.intersects(canvas) || !panel.intersects(geometry())) return;
        dock->move(place + QPoint(place.x() > canvas.x() ? -kFloatedAsidePx : kFloatedAsidePx, 0));
    });
}

void MainWindow::addDock(const QString& name, QAction* shown, QWidget* content, bool scrolls) {
    auto* dock = new QDockWidget(shown->text().remove('&'), this);
    dock->setObjectName(name);
    dock->setAllowedAreas(Qt::LeftDockWidgetArea | Qt::RightDockWidgetArea);
    // Whether it is open, be it behind another one's tab or not.
    connect(dock->toggleViewAction(), &QAction::toggled, shown, &QAction::setChecked);
    connect(shown, &QAction::triggered, dock, [dock](bool show) {
        dock->setVisible(show);
        if (show) dock->raise();
    });
    content->setMinimumWidth(kPanelWidthPx);
    if (scrolls) {
        auto* area = new QScrollArea;
        area->setWidgetResizable(true);
        area->setFrameShape(QFrame::NoFrame);
        area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        area->setWidget(content);
        area->setMinimumWidth(kPanelWidthPx + area->verticalScrollBar()->sizeHint().width());
        dock->setWidget(area);
    } else {
        dock->setWidget(content);
    }
    // Not at the start, where it is to be where it was left.
    connect(dock, &QDockWidget::topLevelChanged, this, [this, dock](bool floats) {
        if (floats && isVisible()) moveAside(dock);
    });
    mDocks.append(dock);
}

void MainWindow::setPanelsHidden(bool hidden) {
    if (hidden) {
        mHiddenDocks.clear();
        for (QDockWidget* dock : mDocks)
            if (!dock->isHidden()) mHiddenDocks.append(dock);
        // Those in front at the end: of those behind one tab bar, the last one to be raised is in front.
        std::stable_partition(mHiddenDocks.begin(), mHiddenDocks.end(),
                              [](const QDockWidget* dock) { return dock->visibleRegion().isEmpty(); });
    }
    for (QDockWidget* dock : mHiddenDocks) {
        dock->setVisible(!hidden);
        if (!hidden) dock->raise();
    }
    mToolBar->setVisible(!hidden);
    mToolOptions->setVisible(!hidden);
}

void MainWindow::restoreWindow() {
    if (!restoreGeometry(mSettings.blob("geometry"))) resize(kFirstSize.boundedTo(screen()->availableSize()));
    restoreState(mSettings.blob("state"), kStateVersion);
    const QByteArrayList shown = mSettings.blob("toggles").split(' ');
    for (const ActionId id : kRememberedToggles) {
        QAction* action = (*mActions)[id];
        action->setChecked(shown.contains(action->objectName().toUtf8()));
    }
    mTools.setOptions(mSettings.toolOptions());
}

void MainWindow::storeWindow() {
    // What Hide Panels hides is open.
    (*mActions)[ActionId::HidePanels]->setChecked(false);
    mSettings.setBlob("geometry", saveGeometry());
    mSettings.setBlob("state", saveState(kStateVersion));
    QByteArrayList shown;
    for (const ActionId id : kRememberedToggles)
        if ((*mActions)[id]->isChecked()) shown.append((*mActions)[id]->objectName().toUtf8());
    mSettings.setBlob("toggles", shown.join(' '));
    mSettings.setToolOptions(mTools.options());
}

}  // namespace tessera
