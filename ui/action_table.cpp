// See action_table.h.
#include "ui/action_table.h"

#include <QMenu>
#include <QMenuBar>
#include <QWidget>

#include "ui/icons.h"

namespace tessera {

namespace {

constexpr unsigned kCheckable = 1, kEndsGroup = 2, kKeyOnly = 4;

struct ActionSpec {
    ActionId id;
    const char* name;  // stable: the key of a user's own shortcut in the settings
    const char* menu;
    const char* text;
    const char* keys;  // portable, separated by "; "
    const char* tip;
    unsigned flags = 0;
    const char* icon = "";
};

// In menu order.
const ActionSpec kActions[] = {
    {ActionId::New, "new", "&File", "&New", "Ctrl+N", "Begin with another picture, in a tab of its own"},
    {ActionId::Open, "open", "&File", "&Open…", "Ctrl+O", "Open a photo or a Tessera document", 0, "open"},
    {ActionId::Paste, "paste", "&File", "New from Clip&board", "Ctrl+V",
     "Make a document of the picture in the clipboard", 0, "paste"},
    {ActionId::Close, "close", "&File", "&Close", "Ctrl+W", "Close the document", kEndsGroup},
    {ActionId::Save, "save", "&File", "&Save", "Ctrl+S", "Save the vector image", 0, "save"},
    {ActionId::SaveAs, "saveAs", "&File", "Save &As…", "Ctrl+Shift+S",
     "Save the vector image under another name", kEndsGroup},
    {ActionId::Export, "export", "&File", "&Export Picture…", "Ctrl+E",
     "Write a PNG, JPEG, TIFF or EXR of any size", 0, "export"},
    {ActionId::ExportAgain, "exportAgain", "&File", "Export A&gain", "Ctrl+Shift+E",
     "Write the same kind of picture to the same file as last time"},
    {ActionId::Relink, "relink", "&File", "Find the P&hoto…", "",
     "Choose the photo that the document was made from", kEndsGroup, "picture"},
    {ActionId::Preferences, "preferences", "&File", "P&references…", "Ctrl+,", "Look, keys, autosave, memory",
     kEndsGroup, "settings"},
    {ActionId::Quit, "quit", "&File", "&Quit", "Ctrl+Q", "Close Tessera"},
    {ActionId::Undo, "undo", "&Edit", "&Undo", "Ctrl+Z", "Take back the last step", 0, "undo"},
    {ActionId::Redo, "redo", "&Edit", "&Redo", "Ctrl+Shift+Z; Ctrl+Y", "Do the step again", kEndsGroup,
     "redo"},
    {ActionId::Copy, "copy", "&Edit", "&Copy as Picture", "Ctrl+C",
     "Copy the selected patches, or the whole picture, to the clipboard", kEndsGroup},
    {ActionId::SelectAll, "selectAll", "&Edit", "Select &All", "Ctrl+A", "Select all patches"},
    {ActionId::SelectNone, "selectNone", "&Edit", "Select &None", "Ctrl+Shift+A", "Select nothing"},
    {ActionId::InvertSelection, "invertSelection", "&Edit", "&Invert Selection", "Ctrl+Shift+I",
     "Select what is not selected", 0, "invert"},
    {ActionId::GrowSelection, "growSelection", "&Edit", "&Grow Selection",
     "Ctrl+Alt+=", "Add the patches beside the selection", 0, "grow"},
    {ActionId::ShrinkSelection, "shrinkSelection", "&Edit", "&Shrink Selection", "Ctrl+Alt+-",
     "Leave out the patches at the selection's border", 0, "shrink"},
    {ActionId::SelectSimilar, "selectSimilar", "&Edit", "Select Si&milar Colours", "",
     "Add the patches that have the colour of those selected, by the wand's tolerance", kEndsGroup, "wand"},
    {ActionId::ResetColours, "resetColours", "&Patches", "Reset &Colours", "",
     "Give the selected patches the colours that they were fitted with", 0, "reset"},
    {ActionId::ResetShape, "resetShape", "&Patches", "Reset S&hape", "",
     "Give the selected patches the shape that they were fitted with"},
    {ActionId::RefitColours, "refitColours", "&Patches", "&Refit Colours from the Photo", "",
     "Fit the colours of the selected patches to the photo", kEndsGroup, "refit"},
    {ActionId::Hide, "hide", "&Patches", "&Hide", "Ctrl+3",
     "Do not draw the selected patches on the canvas; exports still have them", 0, "eye-off"},
    {ActionId::ShowAll, "showAll", "&Patches", "Show &All", "Ctrl+Alt+3", "Draw all patches again", 0, "eye"},
    {ActionId::Lock, "lock", "&Patches", "&Lock", "Ctrl+2",
     "Keep the selected patches from being selected and changed", 0, "lock"},
    {ActionId::UnlockAll, "unlockAll", "&Patches", "&Unlock All", "Ctrl+Alt+2", "Unlock all patches", 0,
     "unlock"},
    {ActionId::CutOut, "cutOut", "&Patches", "Cut &Out", "",
     "Make the selected patches transparent, in exports too; a dashed line runs around them", 0, "cut-out"},
    {ActionId::FillIn, "fillIn", "&Patches", "Fill &In", "", "Make the selected patches opaque again",
     kEndsGroup},
    {ActionId::SplitPatches, "splitPatches", "&Patches", "&Split Patches", "",
     "Split each selected patch at its middle", 0, "split"},
    {ActionId::SplitCurves, "splitCurves", "&Patches", "Split C&urves", "",
     "Split the selected curves at their middle"},
    {ActionId::MergeCurves, "mergeCurves", "&Patches", "&Merge along Curves", "",
     "Remove the selected curves by joining their ends", 0, "merge"},
    {ActionId::SnapToFeature, "snapToFeature", "&Patches", "Snap to &Photo", "",
     "Move the selected curves onto the strongest edge of the photo nearby", 0, "snap"},
    {ActionId::MarkFeature, "markFeature", "&Patches", "Mark as &Feature", "",
     "Let colours jump across the selected curves", 0, "features"},
    {ActionId::UnmarkFeature, "unmarkFeature", "&Patches", "Un&mark as Feature", "",
     "Let colours run on across the selected curves"},
    {ActionId::ZoomIn, "zoomIn", "&View", "Zoom &In", "Ctrl++; Ctrl+=", "Zoom in"},
    {ActionId::ZoomOut, "zoomOut", "&View", "Zoom &Out", "Ctrl+-", "Zoom out"},
    {ActionId::ZoomFit, "zoomFit", "&View", "&Fit in Window", "Ctrl+0", "Show the whole picture", 0, "fit"},
    {ActionId::Zoom100, "zoom100", "&View", "&100 %", "Ctrl+1",
     "One image pixel for each pixel of the screen", 0, "actual-size"},
    {ActionId::FitSelection, "fitSelection", "&View", "Fit &Selection", "3",
     "Show what is selected as large as fits"},
    {ActionId::PreviousZoom, "previousZoom", "&View", "Pre&vious Zoom", "`",
     "Go back to the zoom before, or forth again", kEndsGroup},
    {ActionId::Pan, "pan", "&View", "Move the Picture (held)", "Space", "Hold it and drag", kKeyOnly},
    {ActionId::ShowFeatures, "showFeatures", "&View", "F&eatures", "Alt+1",
     "Draw the curves along which colours jump", kCheckable, "features"},
    {ActionId::ShowBlur, "showBlur", "&View", "Features by &Blur", "Alt+4",
     "Colour features by how soft they are: yellow is crisp, blue is soft", kCheckable, "blur"},
    {ActionId::ShowImportance, "showImportance", "&View", "Features by I&mportance", "Alt+7",
     "Colour features by how far colours jump across them: yellow is far, blue is hardly", kCheckable},
    {ActionId::ShowEdges, "showEdges", "&View", "&Patch Edges", "Alt+2", "Draw the edges of the patches",
     kCheckable, "edges"},
    {ActionId::ShowControlPoints, "showControlPoints", "&View", "&Control Points", "Alt+3",
     "Draw vertices and curve handles, where the view is close enough", kCheckable, "control-points"},
    {ActionId::ShowCentres, "showCentres", "&View", "Spline Ce&ntres", "Alt+8",
     "Draw the points inside each patch from which its colours are blended, where the view is close enough",
     kCheckable},
    {ActionId::ShowHeatMap, "showHeatMap", "&View", "Error &Heat Map", "Alt+5",
     "Paint over the picture how far it is from the photo", kCheckable, "heat-map"},
    {ActionId::OutlineView, "outlineView", "&View", "Cycle &Outline View", "Ctrl+5",
     "Features, then patch edges too, then control points too, then none", kEndsGroup},
    {ActionId::ShowOriginal, "showOriginal", "&View", "Show O&riginal Photo", "",
     "Show the photo in place of the vector image", kCheckable, "picture"},
    {ActionId::PeekOriginal, "peekOriginal", "&View", "See the Original (held)", "O",
     "Show the photo for as long as it is held", kKeyOnly},
    {ActionId::Split, "split", "&View", "Split Vie&w", "Ctrl+6",
     "The photo left of a line that can be dragged, the vector image right of it", kCheckable, "split-view"},
    {ActionId::XRay, "xray", "&View", "&X-Ray", "Alt+6", "The photo in a lens at the pointer",
     kCheckable | kEndsGroup, "xray"},
    {ActionId::Rulers, "rulers", "&View", "R&ulers", "Ctrl+R", "Rulers in image pixels", kCheckable,
     "rulers"},
    {ActionId::HidePanels, "hidePanels", "&View", "&Hide Panels", "Tab", "Hide the panels", kCheckable},
    {ActionId::FullScreen, "fullScreen", "&View", "F&ull Screen", "F11", "Fill the screen", kCheckable},
    {ActionId::Vectorize, "vectorize", "&Image", "&Vectorize", "Ctrl+Return", "Turn the photo into patches",
     0, "vectorize"},
    {ActionId::Cancel, "cancel", "&Image", "&Cancel", "Ctrl+.", "Stop what is running", 0, "hourglass"},
    {ActionId::ToolSelect, "toolSelect", "&Tools", "&Select", "V",
     "Select patches by click or marquee; a double click selects what features enclose", kCheckable,
     "select"},
    {ActionId::ToolDirect, "toolDirect", "&Tools", "&Direct Select", "A",
     "Drag vertices, handles and whole curves", kCheckable, "direct-select"},
    {ActionId::ToolLasso, "toolLasso", "&Tools", "&Lasso", "Q", "Select patches by drawing around them",
     kCheckable, "lasso"},
    {ActionId::ToolWand, "toolWand", "&Tools", "&Wand", "Y", "Select patches of like colour", kCheckable,
     "wand"},
    {ActionId::ToolEyedropper, "toolEyedropper", "&Tools", "&Eyedropper", "I",
     "Pick up a colour; Shift gives it to the selection, Alt takes it from the original", kCheckable,
     "eyedropper"},
    {ActionId::ToolBrush, "toolBrush", "&Tools", "Recolour &Brush", "B", "Paint the current colour",
     kCheckable, "brush"},
    {ActionId::ToolDragColour, "toolDragColour", "&Tools", "Drag &Colour", "C",
     "Carry a colour from one place to another", kCheckable, "drag-colour"},
    {ActionId::ToolGradient, "toolGradient", "&Tools", "&Gradient", "G",
     "Draw a gradient across the selection", kCheckable, "gradient"},
    {ActionId::ToolBlur, "toolBlur", "&Tools", "&Soften", "S",
     "Make a feature softer or sharper by its handle", kCheckable, "blur"},
    {ActionId::ToolHand, "toolHand", "&Tools", "&Hand", "H", "Move the view", kCheckable, "hand"},
    {ActionId::ToolZoom, "toolZoom", "&Tools", "&Zoom", "Z", "Zoom in by click or marquee; Alt zooms out",
     kCheckable, "zoom"},
    {ActionId::LargerBrush, "largerBrush", "&Tools", "Lar&ger Brush", "]", "Make the brush larger"},
    {ActionId::SmallerBrush, "smallerBrush", "&Tools", "Smalle&r Brush", "[", "Make the brush smaller"},
    {ActionId::NudgeLeft, "nudgeLeft", "&Tools", "Nudge Left", "Left", "Move what is selected", kKeyOnly},
    {ActionId::NudgeRight, "nudgeRight", "&Tools", "Nudge Right", "Right", "Move what is selected", kKeyOnly},
    {ActionId::NudgeUp, "nudgeUp", "&Tools", "Nudge Up", "Up", "Move what is selected", kKeyOnly},
    {ActionId::NudgeDown, "nudgeDown", "&Tools", "Nudge Down", "Down", "Move what is selected", kKeyOnly},
    {ActionId::ShowVectorizePanel, "showVectorizePanel", "&Window", "&Vectorize", "",
     "The panel that turns photos into patches", kCheckable},
    {ActionId::ShowRecolourPanel, "showRecolourPanel", "&Window", "&Recolour", "",
     "The panel that recolours the selection", kCheckable},
    {ActionId::ShowPalettePanel, "showPalettePanel", "&Window", "&Palette", "",
     "The panel of dominant colours and swatches", kCheckable},
    {ActionId::ShowSelectionPanel, "showSelectionPanel", "&Window", "&Selection", "",
     "The panel of what is selected and of named selections", kCheckable},
    {ActionId::ShowHistoryPanel, "showHistoryPanel", "&Window", "&History", "",
     "The panel of the steps that can be gone back", kCheckable},
    {ActionId::ShowNavigatorPanel, "showNavigatorPanel", "&Window", "&Navigator", "",
     "The panel that shows where in the picture one is", kCheckable | kEndsGroup},
    {ActionId::ResetPanels, "resetPanels", "&Window", "Reset &Panels", "",
     "Open all panels at the places that they had at first"},
    {ActionId::CheatSheet, "cheatSheet", "&Help", "&Keys and Gestures", "?", "All keys on one sheet", 0,
     "keyboard"},
    {ActionId::About, "about", "&Help", "&About Tessera", "", "What this program is"},
};

QString translated(const char* text) {
    return QObject::tr(text);
}

QString plain(const char* text) {
    return translated(text).remove('&');
}

QList<QKeySequence> tableKeys(const ActionSpec& spec) {
    return QKeySequence::listFromString(spec.keys, QKeySequence::PortableText);
}

void setKeys(QAction* action, const ActionSpec& spec, const QList<QKeySequence>& keys) {
    action->setShortcuts(keys);
    const QString key = action->shortcut().toString(QKeySequence::NativeText);
    action->setToolTip(key.isEmpty() ? translated(spec.tip) : translated(spec.tip) + " (" + key + ")");
}

}  // namespace

ActionId actionOf(ToolId tool) {
    return ActionId(int(ActionId::ToolSelect) + int(tool));
}

ActionTable::ActionTable(QWidget* window, const Settings& settings) {
    for (const ActionSpec& spec : kActions) {
        auto* action = new QAction(translated(spec.text), window);
        action->setObjectName(spec.name);
        action->setCheckable(spec.flags & kCheckable);
        action->setStatusTip(translated(spec.tip));
        // So that keys work with the menu bar hidden, and none is lost in a panel.
        if (!(spec.flags & kKeyOnly)) window->addAction(action);
        mActions[size_t(spec.id)] = action;
    }
    applyKeys(settings);
    tintIcons(window->palette());
}

void ActionTable::applyKeys(const Settings& settings) {
    QList<KeyRow> rows = keyRows();
    const QList<QKeySequence> preset = presetKeys(settings.keyPreset(), rows);
    for (int i = 0; i < rows.size(); ++i) rows[i].current = settings.key(rows[i].name).value_or(preset[i]);
    for (int i = 0; i < rows.size(); ++i)
        setKeys(mActions[size_t(kActions[i].id)], kActions[i], keysInForce(rows, i));
}

void ActionTable::tintIcons(const QPalette& palette) {
    for (const ActionSpec& spec : kActions)
        if (*spec.icon) mActions[size_t(spec.id)]->setIcon(icon(spec.icon, palette));
}

QList<KeyRow> ActionTable::keyRows() const {
    QList<KeyRow> rows;
    for (const ActionSpec& spec : kActions) {
        const QList<QKeySequence> keys = tableKeys(spec);
        rows.append({.name = spec.name,
                     .text = plain(spec.text),
                     .menu = plain(spec.menu),
                     .def = keys.value(0),
                     .current = mActions[size_t(spec.id)]->shortcut(),
                     .further = keys.mid(1)});
    }
    return rows;
}

void ActionTable::fill(QMenuBar* bar, QMenu* recent) const {
    const char* current = "";
    QMenu* menu = nullptr;
    for (const ActionSpec& spec : kActions) {
        if (spec.flags & kKeyOnly) continue;
        if (qstrcmp(current, spec.menu) != 0) menu = bar->addMenu(translated(current = spec.menu));
        QAction* action = mActions[size_t(spec.id)];
        menu->addAction(action);
        action->setIconVisibleInMenu(false);
        if (spec.id == ActionId::Open) menu->addMenu(recent);
        if (spec.flags & kEndsGroup) menu->addSeparator();
    }
}

}  // namespace tessera
