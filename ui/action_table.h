// One table of everything that a menu or a key can do.
#pragma once

#include <QAction>
#include <QObject>
#include <array>

#include "app/settings.h"

class QMenu;
class QMenuBar;
class QWidget;

namespace tessera {

enum class ActionId {
    Open,
    Save,
    SaveAs,
    Export,
    Quit,
    Undo,
    Redo,
    ZoomIn,
    ZoomOut,
    ZoomFit,
    Zoom100,
    ShowFeatures,
    ShowEdges,
    ShowControlPoints,
    ShowOriginal,
    HidePanels,
    FullScreen,
    DarkTheme,
    Vectorize,
    Cancel,
    About,
    Count
};

constexpr size_t kActionCount = size_t(ActionId::Count);

// The actions of one window, made from the table, with the keys that the user chose or else the table's.
class ActionTable {
  public:
    ActionTable(QWidget* window, const Settings& settings);

    QAction* operator[](ActionId id) const { return mActions[size_t(id)]; }
    // Adds the menus in the table's order; `recent` follows Open.
    void fill(QMenuBar* bar, QMenu* recent) const;

  private:
    std::array<QAction*, kActionCount> mActions{};
};

}  // namespace tessera
