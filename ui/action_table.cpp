// See action_table.h.
#include "ui/action_table.h"

#include <QMenu>
#include <QMenuBar>
#include <QWidget>

namespace tessera {

namespace {

struct ActionSpec {
    ActionId id;
    const char* name;  // stable: the key of a user's own shortcut in the settings
    const char* menu;
    const char* text;
    const char* keys;  // portable, separated by "; "
    const char* tip;
    bool checkable = false;
    bool endsGroup = false;
};

// In menu order.
const ActionSpec kActions[] = {
    {ActionId::Open, "open", "&File", "&Open…", "Ctrl+O", "Open a photo or a Tessera document"},
    {ActionId::Save, "save", "&File", "&Save", "Ctrl+S", "Save the vector image"},
    {ActionId::SaveAs, "saveAs", "&File", "Save &As…", "Ctrl+Shift+S",
     "Save the vector image under another name", false, true},
    {ActionId::Export, "export", "&File", "&Export Picture…", "Ctrl+E",
     "Write a PNG, JPEG, TIFF or EXR of any size", false, true},
    {ActionId::Quit, "quit", "&File", "&Quit", "Ctrl+Q", "Close Tessera"},
    {ActionId::Undo, "undo", "&Edit", "&Undo", "Ctrl+Z", "Take back the last step"},
    {ActionId::Redo, "redo", "&Edit", "&Redo", "Ctrl+Shift+Z; Ctrl+Y", "Do the step again"},
    {ActionId::ZoomIn, "zoomIn", "&View", "Zoom &In", "Ctrl++; Ctrl+=", "Zoom in"},
    {ActionId::ZoomOut, "zoomOut", "&View", "Zoom &Out", "Ctrl+-", "Zoom out"},
    {ActionId::ZoomFit, "zoomFit", "&View", "&Fit in Window", "Ctrl+0", "Show the whole picture"},
    {ActionId::Zoom100, "zoom100", "&View", "&100 %", "Ctrl+1",
     "One image pixel for each pixel of the screen", false, true},
    {ActionId::ShowFeatures, "showFeatures", "&View", "F&eatures", "Alt+1",
     "Draw the curves along which colours jump", true},
    {ActionId::ShowEdges, "showEdges", "&View", "&Patch Edges", "Alt+2", "Draw the edges of the patches",
     true},
    {ActionId::ShowControlPoints, "showControlPoints", "&View", "&Control Points", "Alt+3",
     "Draw vertices and curve handles, where the view is close enough", true, true},
    {ActionId::ShowOriginal, "showOriginal", "&View", "Show O&riginal Photo", "",
     "Show the photo in place of the vector image; hold O to peek at it", true, true},
    {ActionId::HidePanels, "hidePanels", "&View", "&Hide Panels", "Tab", "Hide the panels", true},
    {ActionId::FullScreen, "fullScreen", "&View", "F&ull Screen", "F11", "Fill the screen", true, true},
    {ActionId::DarkTheme, "darkTheme", "&View", "&Dark Theme", "", "Use the dark look", true},
    {ActionId::Vectorize, "vectorize", "&Image", "&Vectorize", "Ctrl+Return", "Turn the photo into patches"},
    {ActionId::Cancel, "cancel", "&Image", "&Cancel", "Ctrl+.", "Stop what is running"},
    {ActionId::About, "about", "&Help", "&About Tessera", "", "What this program is"},
};

QString translated(const char* text) {
    return QObject::tr(text);
}

}  // namespace

ActionTable::ActionTable(QWidget* window, const Settings& settings) {
    for (const ActionSpec& spec : kActions) {
        auto* action = new QAction(translated(spec.text), window);
        action->setObjectName(spec.name);
        action->setCheckable(spec.checkable);
        const auto own = settings.key(spec.name);
        action->setShortcuts(own ? QList<QKeySequence>{*own}
                                 : QKeySequence::listFromString(spec.keys, QKeySequence::PortableText));
        action->setStatusTip(translated(spec.tip));
        const QString key = action->shortcut().toString(QKeySequence::NativeText);
        action->setToolTip(key.isEmpty() ? translated(spec.tip) : translated(spec.tip) + " (" + key + ")");
        // So that keys work with the menu bar hidden, and none is lost in a panel.
        window->addAction(action);
        mActions[size_t(spec.id)] = action;
    }
}

void ActionTable::fill(QMenuBar* bar, QMenu* recent) const {
    const char* current = "";
    QMenu* menu = nullptr;
    for (const ActionSpec& spec : kActions) {
        if (qstrcmp(current, spec.menu) != 0) menu = bar->addMenu(translated(current = spec.menu));
        menu->addAction(mActions[size_t(spec.id)]);
        if (spec.id == ActionId::Open) {
            menu->addMenu(recent);
            menu->addSeparator();
        }
        if (spec.endsGroup) menu->addSeparator();
    }
}

}  // namespace tessera
