// The panel with which a photo is vectorized, and in which the result is judged and looked into.
#pragma once

#include <QWidget>
#include <optional>

#include "app/settings.h"
#include "core/vectorize/settings.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QHBoxLayout;
class QLabel;
class QPushButton;

namespace tessera {

class ActionTable;
class AmountField;
class DocumentSession;
class GestureSlider;

class VectorizePanel : public QWidget {
    Q_OBJECT

  public:
    VectorizePanel(Settings& settings, const ActionTable& actions, QWidget* parent = nullptr);

    // What the user asks for: the document's own settings with what the panel's fields say.
    VectorizeSettings settings(const DocumentSession* session) const;
    // The mean error that is wanted in the place of settings().patches, in levels of 255.
    std::optional<double> meanError() const;
    void setPatches(int patches);
    // How many patches the draft on the canvas has; none where it shows the document.
    void showDraft(std::optional<size_t> patches);
    // Makes the fields say what a document was made with.
    void showSettings(const VectorizeSettings& settings);
    // Shows what the document holds, or the draft on the canvas that is seen in its place; null where none is
    // open.
    void showSession(const DocumentSession* session, size_t features, std::optional<size_t> draft = {});

  signals:
    // The draft of settings() would be good to see; it is not wanted any more.
    void draftWanted();
    void draftDropped();

  private:
    QWidget* makeVectorizePart(const ActionTable& actions);
    AmountField* makeAmountField();
    QLayout* makeQualityRow();
    QWidget* makeFeaturesPart();
    QWidget* makeEdgeContrastPart();
    QPushButton* makeVectorizeButton(const ActionTable& actions);
    QWidget* makePhotoMissingPart(const ActionTable& actions);
    QCheckBox* makeOption(const QString& text, bool on, void (Settings::*set)(bool));
    bool paperChosen() const;
    void showFieldsOfMethod();
    QWidget* makeResultPart();
    void showFigures(const DocumentSession& session, size_t features, std::optional<size_t> draft);
    QWidget* makeShowPart(const ActionTable& actions);

    Settings& mSettings;
    AmountField* mAmount = nullptr;
    bool mDraftShown = false;
    QComboBox* mQuality = nullptr;  // its data: a preset's name, or the paper's method; none is "custom"
    QWidget* mFeaturesPart = nullptr;
    GestureSlider* mFeatures = nullptr;  // in percent
    QWidget* mEdgeContrastPart = nullptr;
    QDoubleSpinBox* mEdgeContrast = nullptr;  // in percent
    QPushButton* mApply = nullptr;
    QWidget* mPhotoMissing = nullptr;  // how to go on without
    QWidget* mResult = nullptr;
    QFormLayout* mFigures = nullptr;
    QLabel* mShortfall = nullptr;
};

}  // namespace tessera
