// What the canvas shows while the first file is on its way: its name, and how far it is.
#pragma once

#include <QWidget>

class QLabel;
class QProgressBar;
class QPushButton;

namespace tessera {

class Job;

class OpeningCard : public QWidget {
    Q_OBJECT

  public:
    explicit OpeningCard(QWidget* parent = nullptr);

    // Null: nothing is being opened.
    void showJob(const Job* job);

  signals:
    void cancelRequested();

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    QLabel* mText;
    QProgressBar* mProgress;
    QPushButton* mCancel;
};

}  // namespace tessera
