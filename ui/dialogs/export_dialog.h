// Asks what kind of picture to export, how large, and in which colours.
#pragma once

#include <QColor>
#include <QDialog>
#include <QSize>

#include "app/jobs/export_job.h"
#include "app/settings.h"

class QCheckBox;
class QComboBox;
class QDialogButtonBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSpinBox;
class QToolButton;

namespace tessera {

// Begins with what was chosen last time.
class ExportDialog : public QDialog {
    Q_OBJECT

  public:
    // `picture` is the size at 100 %; `photoProfile` the ICC profile of the photo, empty where it had none.
    ExportDialog(QSize picture, std::vector<uint8_t> photoProfile, Settings& settings,
                 QWidget* parent = nullptr);

    // What was chosen; the path is still to be asked for.
    ExportRequest request() const;
    // The suffix of the chosen format, without a dot, and its filter for a file dialog.
    QString suffix() const;
    QString filter() const;

    void accept() override;

  private:
    void makeFields(const QString& profileName);
    QLayout* makeSizeRow();
    void makeLayout();
    void connectFields();
    void restore();
    void store() const;

    // Makes the other fields of the size follow the one that changed.
    void scaleChanged();
    void sideChanged(QSpinBox* changed, QSpinBox* other);
    void chooseColour();
    void setColour(const QColor& colour);
    // What depends on the format and the size.
    void update();
    QSize size() const;
    // Why this size cannot be exported, or what to expect of it; empty for nothing special.
    QString sizeProblem() const;
    QString sizeWarning() const;
    bool hasBackground() const;

    const QSize mPicture;
    const std::vector<uint8_t> mPhotoProfile;
    Settings& mSettings;
    QColor mColour = Qt::white;
    QComboBox* mFormat;
    QDoubleSpinBox* mScale;
    QSpinBox* mWidth;
    QSpinBox* mHeight;
    QToolButton* mLinked;
    QLabel* mSize;
    QComboBox* mSamples;
    QComboBox* mDepth;
    QSpinBox* mQuality;
    QComboBox* mProfile;
    QComboBox* mBackground;
    QPushButton* mSwatch;
    QDialogButtonBox* mButtons;
    QPushButton* mExport;
};

}  // namespace tessera
