// Asks what kind of picture to export, and how large.
#pragma once

#include <QDialog>
#include <QSize>

#include "app/jobs/export_job.h"

class QComboBox;
class QDialogButtonBox;
class QDoubleSpinBox;
class QLabel;
class QSpinBox;

namespace tessera {

class ExportDialog : public QDialog {
    Q_OBJECT

  public:
    // `picture` is the size at 100 %.
    explicit ExportDialog(QSize picture, QWidget* parent = nullptr);

    // What was chosen; the path is still to be asked for.
    ExportRequest request() const;
    // The suffix of the chosen format, without a dot, and its filter for a file dialog.
    QString suffix() const;
    QString filter() const;

  private:
    void update();

    QSize mPicture;
    QComboBox* mFormat;
    QDoubleSpinBox* mScale;
    QLabel* mSize;
    QComboBox* mDepth;
    QSpinBox* mQuality;
    QDialogButtonBox* mButtons;
};

}  // namespace tessera
