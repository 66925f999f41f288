// A button that is a colour, with a word below it where there is one.
#pragma once

#include <QColor>
#include <QToolButton>

namespace tessera {

class SwatchButton : public QToolButton {
    Q_OBJECT

  public:
    explicit SwatchButton(QWidget* parent = nullptr);

    void setColour(const QColor& colour);
    const QColor& colour() const { return mColour; }
    // Below the colour; empty for none.
    void setCaption(const QString& caption);

    QSize sizeHint() const override;
    QSize minimumSizeHint() const override;

  signals:
    void hovered(bool on);
    // A click, or Space.
    void picked(Qt::KeyboardModifiers modifiers);
    // A double click, or Return.
    void editRequested();

  protected:
    void paintEvent(QPaintEvent* event) override;
    void enterEvent(QEnterEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    Qt::KeyboardModifiers mModifiers;  // of the last event
    QColor mColour;
    QString mCaption;
};

}  // namespace tessera
