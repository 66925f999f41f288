// The dominant colours of the picture, and the user's own swatches.
#pragma once

#include <QPointer>
#include <QTimer>
#include <QWidget>
#include <optional>

#include "app/recolour_gesture.h"
#include "app/swatch_store.h"
#include "core/edit/palette.h"

class QGridLayout;
class QLabel;
class QSpinBox;

namespace tessera {

class ColourPopup;
class Job;
class SwatchButton;
class ToolManager;

// Dominant colours are found on a worker, when the document rests and the panel is seen. A click on one
// selects its patches (Shift adds, Alt subtracts), a double click or Return changes the colour in the whole
// picture. A click on an own swatch makes it the colour of the tools.
class PalettePanel : public QWidget {
    Q_OBJECT

  public:
    // The store outlives the panel.
    explicit PalettePanel(SwatchStore& store, QWidget* parent = nullptr);
    ~PalettePanel() override;

    // Null for none.
    void setSession(DocumentSession* session);
    // Whose colour swatches set, and which end gestures; outlives the panel.
    void setToolOptions(ToolManager& tools) { mTools = &tools; }

    // Whether the colours shown are those of the document as it is.
    bool current() const;
    int colourCount() const;
    // Files of swatches; what fails is said.
    void importFrom(const QString& path);
    void exportTo(const QString& path);

  signals:
    // The patches of the colour under the pointer; empty when it leaves.
    void highlighted(const tessera::PatchSet& patches);
    // One sentence for the person.
    void said(const QString& text);

  protected:
    void showEvent(QShowEvent* event) override;
    void hideEvent(QHideEvent* event) override;

  private:
    QWidget* makePalettePart();
    QWidget* makeSwatchPart();
    void findSoon();
    void find();
    void showPalette();
    SwatchButton* makeEntry(int entry);
    void highlight(int entry);
    void select(int entry, Qt::KeyboardModifiers modifiers);
    void edit(int entry);
    void preview(glm::dvec3 colour);
    void finishEdit(std::optional<glm::dvec3> colour);
    void useColour(glm::dvec3 colour);
    void showSwatches();
    void askImport();
    void askExport();

    QPointer<DocumentSession> mSession;
    ToolManager* mTools = nullptr;
    SwatchStore& mStore;
    QTimer mRest;
    QPointer<Job> mJob;
    Palette mPalette;
    uint64_t mRevision = 0;  // that mPalette is of; 0 for none
    int mCount = 0;          // and how many colours were asked for
    bool mHighlighting = false;

    // While a colour is being changed.
    int mEntry = 0;
    std::optional<RecolourGesture> mGesture;

    QSpinBox* mColours = nullptr;
    QLabel* mHint = nullptr;
    QGridLayout* mEntries = nullptr;
    QGridLayout* mSwatches = nullptr;
    QLabel* mSwatchHint = nullptr;
    ColourPopup* mPopup;
};

}  // namespace tessera
