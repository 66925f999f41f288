// How many patches a vectorization shall make: as a number, by detail, or by the error that they may leave.
#pragma once

#include <QSize>
#include <QWidget>
#include <optional>

#include "app/settings.h"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QSpinBox;
class QStackedWidget;

namespace tessera {

class GestureSlider;

// Begins with what was chosen last time, and remembers every choice.
class AmountField : public QWidget {
    Q_OBJECT

  public:
    explicit AmountField(Settings& settings, QWidget* parent = nullptr);

    // What comes of it for the picture that is open.
    int patches() const;
    // The mean error that is wanted in the place of a number, in levels of 255.
    std::optional<double> meanError() const;
    // Asks for a number.
    void setPatches(int patches);
    // The picture that is open; empty for none.
    void setPicture(QSize picture);
    // Whether there is a way to find the patches for an error.
    void setErrorPossible(bool possible);
    // How many patches the draft on the canvas has; none where it shows the document.
    void showDraft(std::optional<size_t> patches);

  signals:
    // The slider has been moved: the draft of patches() would be good to see.
    void draftWanted();
    void draftDropped();

  protected:
    void keyPressEvent(QKeyEvent* event) override;

  private:
    // The pages of the stack, in the order of the choice.
    enum Kind { Patches, Detail, Error };

    void makeFields();
    void makeSlider();
    Kind kind() const;
    void choose(int kind);
    int mostPatches() const;
    int patchesAt(int tick) const;
    int tickOf(int patches) const;
    // The slider has been moved to a tick.
    void follow(int tick);
    // A field has another value.
    void changed();
    void showSlider();
    void showHint();

    Settings& mSettings;
    QSize mPicture;
    std::optional<size_t> mDraft;
    QComboBox* mKind;
    QStackedWidget* mStack;
    QSpinBox* mPatches;
    QSpinBox* mDetail;  // in percent
    QDoubleSpinBox* mError;
    GestureSlider* mSlider;
    QLabel* mHint;
};

}  // namespace tessera
