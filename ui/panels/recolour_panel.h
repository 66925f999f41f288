// Recolouring of the selection by sliders and by choice, live, and the colours that the tools use.
#pragma once

#include <QPointer>
#include <array>
#include <optional>

#include "app/colour_adjustment.h"
#include "app/edit_actions.h"
#include "app/recolour_gesture.h"
#include "ui/panels/lazy_panel.h"

class QDoubleSpinBox;
class QGridLayout;
class QLabel;
class QPushButton;
class QSpinBox;

namespace tessera {

class ColourField;
class GestureSlider;
class ToolManager;

class RecolourPanel : public LazyPanel {
    Q_OBJECT

  public:
    explicit RecolourPanel(QWidget* parent = nullptr);
    ~RecolourPanel() override;

    // Null for none.
    void setSession(DocumentSession* session);
    // Whose colours and feather the panel shows and sets, and which end its gestures; outlives it.
    void setToolOptions(ToolManager& tools);

  signals:
    // One sentence for the person.
    void said(const QString& text);

  private:
    // The sliders, by what they change.
    enum Row { Hue, Chroma, Lightness, Brightness, Contrast, TintStrength, RowCount };
    struct Slider {
        GestureSlider* slider = nullptr;
        QSpinBox* field = nullptr;
    };

    QWidget* makeToolColours();
    QWidget* makeSliders();
    void addSlider(QGridLayout* grid, Row row, const QString& name, const QString& tip, int least, int most,
                   const QString& unit);
    QWidget* makeReplacePart();
    QWidget* makeButtons();
    void connectReplace();

    // What the sliders of the row's kind say.
    Recolouring recolouring(Row row) const;
    RecolourOptions recolourOptions() const;
    FinishGesture finish() const;
    void beginRow(Row row, const QString& text);
    void finishAdjustment();
    void showValues();
    void setRow(Row row, double value);

    bool beginReplace();
    void replaceBy(glm::dvec3 colour);
    void say(const Result<void>& result);

    void setColours(glm::dvec3 colour, glm::dvec3 second);
    void showOptions();
    void refresh() override;

    QPointer<DocumentSession> mSession;
    ToolManager* mTools = nullptr;
    std::optional<ColourAdjustment> mAdjustment;
    std::optional<RecolourGesture> mReplace;

    ColourField* mColour = nullptr;
    ColourField* mSecondColour = nullptr;
    QLabel* mHint = nullptr;
    QWidget* mEdits = nullptr;  // what needs a selection
    std::array<Slider, RowCount> mSliders;
    ColourField* mMean = nullptr;
    QDoubleSpinBox* mFeather = nullptr;
    QPushButton* mCutOut = nullptr;
    bool mAllCutOut = false;
};

}  // namespace tessera
