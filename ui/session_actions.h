// The actions that do one thing to the current document or its selection, and when they can.
#pragma once

#include <QObject>
#include <functional>

#include "app/document_session.h"
#include "app/tools/tool_manager.h"

namespace tessera {

class ActionTable;

// Connects those actions. `session` names the document that they are about, null for none; `say` gets one
// sentence about what failed or was left out.
void connectSessionActions(const ActionTable& actions, QObject* receiver,
                           std::function<DocumentSession*()> session, const ToolManager& tools,
                           std::function<void(const QString&)> say);

// Enables each of them where it would find what it works on.
void enableSessionActions(const ActionTable& actions, const DocumentSession* session);

}  // namespace tessera
