// One table of everything that a menu or a key can do.
#pragma once

#include <QAction>
#include <QObject>
#include <array>

#include "app/settings.h"
#include "app/tools/tool.h"
#include "ui/dialogs/key_presets.h"

class QMenu;
class QMenuBar;
class QWidget;

namespace tessera {

enum class ActionId {
    New,
    Open,
    Paste,
    Close,
    Save,
    SaveAs,
    Export,
    ExportAgain,
    Relink,
    Preferences,
    Quit,
    Undo,
    Redo,
    Copy,
    SelectAll,
    SelectNone,
    InvertSelection,
    GrowSelection,
    ShrinkSelection,
    SelectSimilar,
    ResetColours,
    ResetShape,
    RefitColours,
    Hide,
    ShowAll,
    Lock,
    UnlockAll,
    CutOut,
    FillIn,
    SplitPatches,
    SplitCurves,
    MergeCurves,
    SnapToFeature,
    MarkFeature,
    UnmarkFeature,
    ZoomIn,
    ZoomOut,
    ZoomFit,
    Zoom100,
    FitSelection,
    PreviousZoom,
    Pan,  // held
    ShowFeatures,
    ShowBlur,
    ShowImportance,
    ShowEdges,
    ShowControlPoints,
    ShowCentres,
    ShowHeatMap,
    OutlineView,
    ShowOriginal,
    PeekOriginal,  // held
    Split,
    XRay,
    Rulers,
    HidePanels,
    FullScreen,
    Vectorize,
    Cancel,
    ToolSelect,
    ToolDirect,
    ToolLasso,
    ToolWand,
    ToolEyedropper,
    ToolBrush,
    ToolDragColour,
    ToolGradient,
    ToolBlur,
    ToolHand,
    ToolZoom,
    LargerBrush,
    SmallerBrush,
    NudgeLeft,  // and those that follow: with the canvas alone
    NudgeRight,
    NudgeUp,
    NudgeDown,
    ShowVectorizePanel,
    ShowRecolourPanel,
    ShowPalettePanel,
    ShowSelectionPanel,
    ShowHistoryPanel,
    ShowNavigatorPanel,
    ResetPanels,
    CheatSheet,
    About,
    Count
};

constexpr size_t kActionCount = size_t(ActionId::Count);

// The action that takes up a tool.
ActionId actionOf(ToolId tool);

// The actions of one window, made from the table. Keys are those that the user chose, or else the preset's.
// Those that are held or repeated are in no menu and trigger nothing: they are there for their keys.
class ActionTable {
  public:
    ActionTable(QWidget* window, const Settings& settings);

    QAction* operator[](ActionId id) const { return mActions[size_t(id)]; }
    // Adds the menus in the table's order; `recent` follows Open.
    void fill(QMenuBar* bar, QMenu* recent) const;

    // For the preferences and the sheet of keys: all actions, with the table's keys and the present ones.
    QList<KeyRow> keyRows() const;
    // Gives all actions the keys that the settings say now.
    void applyKeys(const Settings& settings);
    // Draws the icons in the palette's colours.
    void tintIcons(const QPalette& palette);

  private:
    std::array<QAction*, kActionCount> mActions{};
};

}  // namespace tessera
