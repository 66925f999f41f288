// See theme.h.
#include "ui/theme.h"

#include <QApplication>
#include <QDockWidget>
#include <QMainWindow>
#include <QPainter>
#include <QPalette>
#include <QProxyStyle>
#include <QStyleOption>
#include <algorithm>

#include "ui/icons.h"

namespace tessera {

namespace {

struct Greys {
    QColor window, base, button, raised, line, text, dim, accent, accentText;
};

const Greys kDark{"#2d2d2d", "#232323", "#3a3a3a", "#353535", "#1d1d1d",
                  "#dedede", "#9d9d9d", "#3d8bd9", "#ffffff"};
const Greys kLight{"#ececec", "#ffffff", "#f7f7f7", "#f4f4f4", "#c4c4c4",
                   "#1f1f1f", "#686868", "#1f6fc0", "#ffffff"};

QPalette paletteOf(const Greys& g) {
    QPalette palette;
    palette.setColor(QPalette::Window, g.window);
    palette.setColor(QPalette::WindowText, g.text);
    palette.setColor(QPalette::Base, g.base);
    palette.setColor(QPalette::AlternateBase, g.raised);
    palette.setColor(QPalette::Text, g.text);
    palette.setColor(QPalette::PlaceholderText, g.dim);
    palette.setColor(QPalette::Button, g.button);
    palette.setColor(QPalette::ButtonText, g.text);
    palette.setColor(QPalette::BrightText, g.accentText);
    palette.setColor(QPalette::ToolTipBase, g.raised);
    palette.setColor(QPalette::ToolTipText, g.text);
    palette.setColor(QPalette::Highlight, g.accent);
    palette.setColor(QPalette::HighlightedText, g.accentText);
    palette.setColor(QPalette::Link, g.accent);
    palette.setColor(QPalette::Light, g.raised.lighter(115));
    palette.setColor(QPalette::Midlight, g.raised);
    palette.setColor(QPalette::Mid, g.line.lighter(125));
    palette.setColor(QPalette::Dark, g.line);
    palette.setColor(QPalette::Shadow, g.line.darker(140));
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
        palette.setColor(QPalette::Disabled, role, g.dim);
    for (const auto role : {QPalette::Base, QPalette::Button})
        palette.setColor(QPalette::Disabled, role, g.window);
    palette.setColor(QPalette::Disabled, QPalette::Highlight, g.button);
    return palette;
}

// %1 line, %2 text, %3 dim, %4 accent, %5 accent text, %6 raised, %7 button, %8 window, %9 handle
const char* const kSheet = R"(
    QMainWindow::separator { background: %1; width: 1px; height: 1px; }
    QMenuBar { border-bottom: 1px solid %1; padding: 2px 4px; }
    QMenuBar::item { padding: 4px 9px; border-radius: 3px; }
    QMenuBar::item:selected { background: %7; }
    QToolBar { border: none; border-bottom: 1px solid %1; background: %8; spacing: 2px; padding: 2px; }
    QToolBar::separator { background: %1; width: 1px; height: 1px; margin: 4px; }
    QStatusBar { border-top: 1px solid %1; }
    QStatusBar::item { border: none; }
    QToolTip { color: %2; background: %6; border: 1px solid %1; padding: 4px 6px; }
    QLabel[role="heading"] { color: %3; font-weight: bold; }
    QLabel[role="dim"] { color: %3; }
    QScrollBar:vertical { background: %8; width: 10px; margin: 0; }
    QScrollBar:horizontal { background: %8; height: 10px; margin: 0; }
    QScrollBar::handle { background: %9; border-radius: 3px; margin: 2px; }
    QScrollBar::handle:vertical { min-height: 28px; }
    QScrollBar::handle:horizontal { min-width: 28px; }
    QScrollBar::handle:hover { background: %3; }
    QScrollBar::add-line, QScrollBar::sub-line { width: 0; height: 0; }
    QScrollBar::add-page, QScrollBar::sub-page { background: none; }
    QPushButton { padding: 6px 14px; border: 1px solid %1; border-radius: 4px; background: %7; }
    QPushButton:hover { border-color: %4; }
    QPushButton:focus { border-color: %4; }
    QPushButton:disabled { color: %3; background: %8; }
    QPushButton[role="primary"] { background: %4; color: %5; border-color: %4; font-weight: bold; }
    QPushButton[role="primary"]:hover, QPushButton[role="primary"]:focus { border-color: %2; }
    QPushButton[role="primary"]:disabled { background: %7; color: %3; border-color: %1; }
    QPushButton[role="small"] { padding: 1px 10px; }
    QProgressBar { border: none; border-radius: 3px; background: %1; max-height: 6px; min-height: 6px; }
    QProgressBar::chunk { border-radius: 3px; background: %4; }
    QFrame[role="line"] { background: %1; border: none; max-height: 1px; min-height: 1px; }
)";

// Whether a panel's tab, beside those of others, says its name.
bool namedByTab(const QDockWidget& dock) {
    const auto* window = qobject_cast<const QMainWindow*>(dock.parentWidget());
    if (!window || dock.isFloating()) return false;
    const QList<QDockWidget*> beside = window->tabifiedDockWidgets(const_cast<QDockWidget*>(&dock));
    return std::any_of(beside.begin(), beside.end(),
                       [](const QDockWidget* other) { return !other->isHidden(); });
}

// Fusion without the shadows under disabled text, without pictures in dialogs' buttons and without gradients
// on the fields that open or count, with crosses in the theme's colours to close tabs and panels by, and with
// no second name under a panel's tab.
class QuietStyle : public QProxyStyle {
  public:
    QuietStyle() : QProxyStyle("Fusion") {}

    void drawComplexControl(ComplexControl control, const QStyleOptionComplex* option, QPainter* painter,
                            const QWidget* widget) const override {
        const auto* combo = qstyleoption_cast<const QStyleOptionComboBox*>(option);
        const auto* spin = qstyleoption_cast<const QStyleOptionSpinBox*>(option);
        if (control == CC_ComboBox && combo && !combo->editable) {
            drawFieldFrame(painter, *option, QPalette::Button);
            drawChevron(painter, *option, subControlRect(control, option, SC_ComboBoxArrow, widget), 1,
                        option->state.testFlag(State_Enabled));
        } else if (control == CC_SpinBox && spin) {
            drawFieldFrame(painter, *option, QPalette::Base);
            if (spin->buttonSymbols == QAbstractSpinBox::NoButtons) return;
            drawChevron(painter, *option, subControlRect(control, option, SC_SpinBoxUp, widget), -1,
                        spin->stepEnabled.testFlag(QAbstractSpinBox::StepUpEnabled));
            drawChevron(painter, *option, subControlRect(control, option, SC_SpinBoxDown, widget), 1,
                        spin->stepEnabled.testFlag(QAbstractSpinBox::StepDownEnabled));
        } else {
            QProxyStyle::drawComplexControl(control, option, painter, widget);
        }
    }

    void drawControl(ControlElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override {
        const auto* dock = qobject_cast<const QDockWidget*>(widget);
        if (element != CE_DockWidgetTitle || !dock)
            return QProxyStyle::drawControl(element, option, painter, widget);
        if (namedByTab(*dock)) return;
        constexpr int kMarginPx = 14;
        const QRect place = subElementRect(SE_DockWidgetTitleBarText, option, widget)
                                .intersected(option->rect.adjusted(kMarginPx, 0, 0, 0));
        const QString title =
            option->fontMetrics.elidedText(dock->windowTitle(), Qt::ElideRight, place.width());
        drawItemText(painter, place, Qt::AlignVCenter | Qt::AlignLeft, option->palette, true, title,
                     QPalette::WindowText);
    }

    int styleHint(StyleHint hint, const QStyleOption* option, const QWidget* widget,
                  QStyleHintReturn* data) const override {
        if (hint == SH_EtchDisabledText || hint == SH_DialogButtonBox_ButtonsHaveIcons) return 0;
        return QProxyStyle::styleHint(hint, option, widget, data);
    }

    QIcon standardIcon(StandardPixmap which, const QStyleOption* option,
                       const QWidget* widget) const override {
        if (qobject_cast<const QDockWidget*>(widget)) {
            if (which == SP_TitleBarCloseButton) return icon("close", widget->palette());
            if (which == SP_TitleBarNormalButton) return icon("float", widget->palette());
        }
        return QProxyStyle::standardIcon(which, option, widget);
    }

    void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                       const QWidget* widget) const override {
        if (element != PE_IndicatorTabClose)
            return QProxyStyle::drawPrimitive(element, option, painter, widget);
        constexpr double kReachPx = 3.5;
        const bool hovered = option->state.testFlag(State_MouseOver);
        const QPointF centre = QRectF(option->rect).center();
        painter->save();
        painter->setRenderHint(QPainter::Antialiasing);
        painter->setPen(
            QPen(option->palette.color(hovered ? QPalette::WindowText : QPalette::PlaceholderText), 1.4,
                 Qt::SolidLine, Qt::RoundCap));
        for (const double side : {-1., 1.})
            painter->drawLine(centre + kReachPx * QPointF(-1, side), centre + kReachPx * QPointF(1, -side));
        painter->restore();
    }

  private:
    static void drawFieldFrame(QPainter* painter, const QStyleOption& option, QPalette::ColorRole ground) {
        const bool enabled = option.state.testFlag(State_Enabled);
        const bool marked =
            enabled && (option.state.testFlag(State_HasFocus) ||
                        (ground == QPalette::Button && option.state.testFlag(State_MouseOver)));
        painter->save();
        painter->setRenderHint(QPainter::Antialiasing);
        painter->setPen(option.palette.color(marked ? QPalette::Highlight : QPalette::Dark));
        painter->setBrush(option.palette.brush(ground));
        painter->drawRoundedRect(QRectF(option.rect).adjusted(.5, .5, -.5, -.5), kFieldCornerPx,
                                 kFieldCornerPx);
        painter->restore();
    }

    // Down for 1, up for -1.
    static void drawChevron(QPainter* painter, const QStyleOption& option, const QRect& rect, int down,
                            bool enabled) {
        constexpr double kHalfWidthPx = 3.5, kHalfHeightPx = 1.75;
        const QPointF tip = QRectF(rect).center() + QPointF(0, down * kHalfHeightPx);
        const double back = -2 * down * kHalfHeightPx;
        painter->save();
        painter->setRenderHint(QPainter::Antialiasing);
        QColor ink = option.palette.color(QPalette::Text);
        if (!enabled) ink.setAlphaF(.3f);
        painter->setPen(QPen(ink, 1.3, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
        painter->drawPolyline(
            QPolygonF{tip + QPointF(-kHalfWidthPx, back), tip, tip + QPointF(kHalfWidthPx, back)});
        painter->restore();
    }

    static constexpr double kFieldCornerPx = 4;
};

}  // namespace

Theme shownTheme(Theme theme) {
    static const bool kDesktopIsDark = QGuiApplication::palette().color(QPalette::Window).lightness() < 128;
    if (theme != Theme::System) return theme;
    return kDesktopIsDark ? Theme::Dark : Theme::Light;
}

CanvasColours canvasColours(Theme theme) {
    if (shownTheme(theme) == Theme::Light)
        return {QColor("#b8b8b8"), QColor(0, 0, 0, 90), QColor("#ffffff"), QColor("#d9d9d9"),
                QColor("#4a4a4a")};
    return {QColor("#1f1f1f"), QColor(0, 0, 0, 200), QColor("#9a9a9a"), QColor("#7c7c7c"), QColor("#9a9a9a")};
}

void applyTheme(QApplication& application, Theme theme) {
    const bool light = shownTheme(theme) == Theme::Light;
    const Greys& g = light ? kLight : kDark;
    application.setStyle(new QuietStyle);
    const QPalette palette = paletteOf(g);
    application.setPalette(palette);
    // Fusion outlines a check box with a darker grey, which cannot be seen on a dark window: fill it lighter.
    QPalette checkBoxes = palette;
    checkBoxes.setColor(QPalette::Base, light ? g.base : g.button.lighter(130));
    QApplication::setPalette(checkBoxes, "QCheckBox");
    QPalette menus = palette;
    menus.setColor(QPalette::Base, light ? g.base : g.raised);
    QApplication::setPalette(menus, "QMenu");
    QString sheet = kSheet;
    for (const QColor& colour : {g.line, g.text, g.dim, g.accent, g.accentText, g.raised, g.button, g.window,
                                 light ? g.line : g.button.lighter(140)})
        sheet = sheet.arg(colour.name());
    application.setStyleSheet(sheet);
}

}  // namespace tessera
