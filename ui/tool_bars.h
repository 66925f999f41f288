// The bars of tools: which one is in use, and what it can be set to.
#pragma once

#include <QToolBar>
#include <functional>
#include <vector>

#include "app/tools/tool_manager.h"
#include "ui/action_table.h"

class QHBoxLayout;
class QStackedWidget;

namespace tessera {

// Buttons of all tools, of which one is down.
class ToolBar : public QToolBar {
    Q_OBJECT

  public:
    // Connects the tools' actions too.
    ToolBar(const ActionTable& actions, ToolManager& tools, QWidget* parent = nullptr);
};

// The options of the tool in use.
class ToolOptionsBar : public QToolBar {
    Q_OBJECT

  public:
    ToolOptionsBar(const ActionTable& actions, ToolManager& tools, QWidget* parent = nullptr);

  private:
    // A page of fields under construction.
    struct Page {
        QWidget* widget;
        QHBoxLayout* row;
    };

    // `hint` names the keys of these actions as %1, %2.
    Page addPage(ToolId tool, const QString& name, const QString& hint, const QList<ActionId>& keys = {});
    void addNumber(const Page& page, const QString& name, const QString& tip, const QString& suffix,
                   double least, double most, double factor, double& (*field)(ToolOptions&));
    void addSwitch(const Page& page, const QString& name, const QString& tip, bool& (*field)(ToolOptions&));
    void addColour(const Page& page, const QString& name, glm::dvec3& (*field)(ToolOptions&));
    void addSource(const Page& page);
    void makeSelectionPages();
    void makeColourPages();
    void makeShapePages();
    void makeViewPages();
    // Changes the options and tells the tools.
    void change(const std::function<void(ToolOptions&)>& edit);
    void refresh();

    const ActionTable& mActions;
    ToolManager& mTools;
    QStackedWidget* mPages;
    std::vector<std::function<void(const ToolOptions&)>> mFields;  // show what they are about
};

}  // namespace tessera
