// The line at the bottom: what is running (with its way to stop it), what is under the cursor, what the
// document holds.
#pragma once

#include <QColor>
#include <QPointF>
#include <QPointer>
#include <QStatusBar>
#include <QTimer>
#include <optional>

#include "app/jobs/job.h"

class QLabel;
class QMenu;
class QProgressBar;
class QPushButton;

namespace tessera {

class DocumentSession;
class StatusBar : public QStatusBar {
    Q_OBJECT

  public:
    explicit StatusBar(QWidget* parent = nullptr);

    // Null: nothing runs.
    void showJob(const Job* job);
    // None without a document.
    void showZoom(std::optional<double> scale);
    // Image pixels and the colour shown there; none outside the picture.
    void showCursor(std::optional<QPointF> image, QColor colour);
    // Of the draft of so many patches that is seen in place of the document, where there is one.
    void showCounts(const DocumentSession* session, size_t features, std::optional<size_t> draft);
    void showSelection(size_t patches);
    // What the canvas is drawn with; `text` says more.
    void showRenderer(bool graphicsCard, const QString& text);

    QString jobText() const;
    // What a click on the zoom opens, to be filled.
    QMenu& zoomMenu();

  signals:
    void cancelRequested();

  private:
    QPointer<const Job> mShown;
    QTimer mAgain;  // the time that is left changes while a job reports nothing, too
    QWidget* mJob;
    QLabel* mJobText;
    QProgressBar* mProgress;
    QPushButton* mCancel;
    QLabel* mCounts;
    QLabel* mSelected;
    QLabel* mRenderer;
    QLabel* mCursor;
    QLabel* mSwatch;
    QLabel* mColour;
    QPushButton* mZoom;
};

// "2,000" in the user's language; "62.5 %" with no more digits than say something.
QString countText(size_t count);
// What is being done in a stage of a job, to a person; empty for a stage that nobody has words for.
QString stageText(const QString& stage);
QString zoomText(double scale);

}  // namespace tessera
