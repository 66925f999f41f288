// The panel with which a photo is vectorized, and in which the result is judged and looked into.
#pragma once

#include <QWidget>

#include "app/settings.h"
#include "core/vectorize/settings.h"

class QCheckBox;
class QDoubleSpinBox;
class QFormLayout;
class QHBoxLayout;
class QLabel;
class QPushButton;
class QSpinBox;
class QToolButton;

namespace tessera {

class ActionTable;
class DocumentSession;

class VectorizePanel : public QWidget {
    Q_OBJECT

  public:
    VectorizePanel(Settings& settings, const ActionTable& actions, QWidget* parent = nullptr);

    // What the user asks for: the document's own settings with the panel's patch count and edge contrast.
    VectorizeSettings settings(const DocumentSession* session) const;
    void setPatches(int patches);
    void setEdgeContrast(double share);
    // Shows what the document holds; null where none is open.
    void showSession(const DocumentSession* session, size_t features);

  signals:
    // The user has finished with a field: keys shall go to the canvas again.
    void editingDone();

  private:
    QWidget* makeVectorizePart(const ActionTable& actions);
    QHBoxLayout* makeEdgeContrastRow();
    QWidget* makeResultPart();
    QWidget* makeShowPart(const ActionTable& actions);

    Settings& mSettings;
    QSpinBox* mPatches = nullptr;
    QDoubleSpinBox* mEdgeContrast = nullptr;  // in percent
    QWidget* mResult = nullptr;
    QFormLayout* mFigures = nullptr;
    QLabel* mShortfall = nullptr;
};

}  // namespace tessera
