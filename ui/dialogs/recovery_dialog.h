// Offers the documents that a run before this one could not save.
#pragma once

#include <QDialog>
#include <vector>

#include "app/recovery_store.h"

class QLabel;
class QListWidget;
class QPushButton;

namespace tessera {

class RecoveryDialog : public QDialog {
    Q_OBJECT

  public:
    // What shall become of the chosen documents; the others are left for the next time.
    enum class Answer { Later, Recover, Discard };

    // `found` in the order in which they are shown, at first all chosen.
    explicit RecoveryDialog(const std::vector<RecoveryInfo>& found, QWidget* parent = nullptr);

    // Later, until the dialog has been accepted.
    Answer answer() const { return mAnswer; }
    // Indices into `found`.
    std::vector<size_t> chosen() const;

  private:
    void makeButtons();
    void finish(Answer answer);
    // Of the two clicks that throw documents away, the first only asks.
    void discardClicked();
    void update();

    Answer mAnswer = Answer::Later;
    bool mAskedToDiscard = false;
    QListWidget* mList;
    QLabel* mWarning;
    QPushButton* mRecover;
    QPushButton* mDiscard;
    QPushButton* mLater;
};

}  // namespace tessera
