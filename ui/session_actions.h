// The actions that do one thing to the current document or its selection, and when they can.
#pragma once

#include <QObject>
#include <functional>

#include "app/tools/tool_manager.h"
#include "app/workspace.h"

namespace tessera {

class ActionTable;

// Connects those actions to the current document of a workspace that outlives them. `say` gets one sentence
// about what failed.
void connectSessionActions(const ActionTable& actions, QObject* receiver, Workspace& workspace,
                           const ToolManager& tools, std::function<void(const QString&)> say);

// Enables each of them where it would find what it works on.
void enableSessionActions(const ActionTable& actions, const DocumentSession* session);

}  // namespace tessera
