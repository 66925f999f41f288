// See tool_bars.h.
#include "ui/tool_bars.h"

#include <QActionGroup>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QStackedWidget>

#include "core/edit/enclosed_region.h"
#include "ui/panels/colour_field.h"
#include "ui/widget_parts.h"

namespace tessera {

namespace {

constexpr int kIconPx = 22;
constexpr int kHeadingGapPx = 10;  // beyond the usual space: the name is no label of the first field
constexpr double kPercent = 100;

}  // namespace

ToolBar::ToolBar(const ActionTable& actions, ToolManager& tools, QWidget* parent)
    : QToolBar(tr("Tools"), parent) {
    setObjectName("toolBar");
    setMovable(false);
    setOrientation(Qt::Vertical);
    setIconSize({kIconPx, kIconPx});
    auto* group = new QActionGroup(this);
    for (int i = 0; i < int(ToolId::Count); ++i) {
        const auto id = ToolId(i);
        QAction* action = actions[actionOf(id)];
        group->addAction(action);
        addAction(action);
        if (id == ToolId::Wand || id == ToolId::Gradient || id == ToolId::Blur) addSeparator();
        connect(action, &QAction::triggered, &tools, [&tools, id] { tools.setTool(id); });
    }
    const auto show = [&actions, &tools] { actions[actionOf(tools.tool())]->setChecked(true); };
    connect(&tools, &ToolManager::toolChanged, this, show);
    show();
}

ToolOptionsBar::ToolOptionsBar(const ActionTable& actions, ToolManager& tools, QWidget* parent)
    : QToolBar(tr("Tool Options"), parent), mActions(actions), mTools(tools), mPages(new QStackedWidget) {
    setObjectName("toolOptionsBar");
    setMovable(false);
    for (int i = 0; i < int(ToolId::Count); ++i) mPages->addWidget(new QWidget);
    addWidget(mPages);
    makeSelectionPages();
    makeColourPages();
    makeShapePages();
    makeViewPages();
    connect(&tools, &ToolManager::optionsChanged, this, &ToolOptionsBar::refresh);
    connect(&tools, &ToolManager::toolChanged, this, [this] { mPages->setCurrentIndex(int(mTools.tool())); });
    mPages->setCurrentIndex(int(tools.tool()));
    refresh();
}

void ToolOptionsBar::makeSelectionPages() {
    const QString modes = tr("Shift adds, Alt subtracts, both intersect");
    const Page select =
        addPage(ToolId::Select, tr("Select"), tr("Double-click: up to the features around. ") + modes);
    addNumber(select, tr("Close gaps"),
              tr("A double-click does not leave through gaps between features that are narrower than this, "
                 "in image pixels"),
              tr(" px"), 0, kMostGapPx, 1, [](ToolOptions& o) -> double& { return o.gapPx; });
    addPage(ToolId::Lasso, tr("Lasso"), modes);
    const Page wand = addPage(ToolId::Wand, tr("Wand"), modes);
    addNumber(wand, tr("Tolerance"), tr("How far colours may be from the one clicked, by how it looks"), {},
              0, 100, kPercent, [](ToolOptions& o) -> double& { return o.wand.tolerance; });
    addSwitch(wand, tr("Contiguous"), tr("Only patches that hang together"),
              [](ToolOptions& o) -> bool& { return o.wand.contiguous; });
    addSwitch(wand, tr("Stop at features"), tr("Do not cross curves along which colours jump"),
              [](ToolOptions& o) -> bool& { return o.wand.stopAtFeatures; });
}

void ToolOptionsBar::makeColourPages() {
    const auto colour = [](ToolOptions& o) -> glm::dvec3& { return o.colour; };
    const auto second = [](ToolOptions& o) -> glm::dvec3& { return o.secondColour; };
    const auto feather = [](ToolOptions& o) -> double& { return o.featherPx; };

    const Page eyedropper = addPage(
        ToolId::Eyedropper, tr("Eyedropper"),
        tr("Shift gives the colour to the selection, Alt swaps the source, %1 held picks from the photo"),
        {ActionId::PeekOriginal});
    addColour(eyedropper, tr("Colour"), colour);
    addSource(eyedropper);

    const Page brush = addPage(ToolId::Brush, tr("Recolour Brush"), tr("%1 and %2 change the size"),
                               {ActionId::SmallerBrush, ActionId::LargerBrush});
    addColour(brush, tr("Colour"), colour);
    addNumber(brush, tr("Size"), tr("The radius, in image pixels"), tr(" px"), .5, 2000, 1,
              [](ToolOptions& o) -> double& { return o.brushRadiusPx; });
    addNumber(brush, tr("Hardness"), tr("How much of the brush is at full strength"), tr(" %"), 0, 100,
              kPercent, [](ToolOptions& o) -> double& { return o.brushHardness; });
    addNumber(brush, tr("Strength"), tr("How much of the colour a stroke lays down"), tr(" %"), 0, 100,
              kPercent, [](ToolOptions& o) -> double& { return o.brushStrength; });
    addSwitch(brush, tr("Keep shading"), tr("Lights and shadows stay what they are"),
              [](ToolOptions& o) -> bool& { return o.brushKeepsShading; });

    const Page drag = addPage(ToolId::DragColour, tr("Drag Colour"),
                              tr("Drag a colour to where it shall be; a click lays the colour down"));
    addColour(drag, tr("Colour"), colour);

    const Page gradient =
        addPage(ToolId::Gradient, tr("Gradient"), tr("Draw a line across the selected patches"));
    addColour(gradient, tr("From"), colour);
    addColour(gradient, tr("To"), second);
    addNumber(gradient, tr("Strength"), tr("How much of the gradient replaces the colours"), tr(" %"), 0, 100,
              kPercent, [](ToolOptions& o) -> double& { return o.gradientStrength; });
    addNumber(gradient, tr("Feather"),
              tr("How far to either side of the selection's border it fades; features stay sharp"), tr(" px"),
              0, 500, 1, feather);
}

void ToolOptionsBar::makeShapePages() {
    const Page direct =
        addPage(ToolId::Direct, tr("Direct Select"),
                tr("Shift keeps to 45°, Alt breaks smooth joins, %1, %2, %3 and %4 nudge by a pixel"),
                {ActionId::NudgeLeft, ActionId::NudgeRight, ActionId::NudgeUp, ActionId::NudgeDown});
    addSwitch(direct, tr("All handles"), tr("Show and take hold of handles that are not selected"),
              [](ToolOptions& o) -> bool& { return o.allHandles; });
    addSwitch(direct, tr("Refit colours"), tr("Fit the colours to the photo again after a change of shape"),
              [](ToolOptions& o) -> bool& { return o.refitAfterReshape; });
    const Page blur = addPage(ToolId::Blur, tr("Soften"), tr("Drag the handle away from a feature"));
    addSwitch(blur, tr("Whole feature"), tr("Up to the next junctions, not the one curve alone"),
              [](ToolOptions& o) -> bool& { return o.wholeFeatures; });
}

void ToolOptionsBar::makeViewPages() {
    addPage(ToolId::Hand, tr("Hand"), tr("Drag to move; hold %1 in any tool"), {ActionId::Pan});
    addPage(ToolId::Zoom, tr("Zoom"), tr("Click or draw a box; Alt zooms out"));
}

ToolOptionsBar::Page ToolOptionsBar::addPage(ToolId tool, const QString& name, const QString& hint,
                                             const QList<ActionId>& keys) {
    auto* widget = mPages->widget(int(tool));
    auto* row = new QHBoxLayout(widget);
    row->setContentsMargins(8, 2, 8, 2);
    row->setSpacing(8);
    auto* heading = headingLabel(name);
    heading->setContentsMargins(0, 0, kHeadingGapPx, 0);
    row->addWidget(heading);
    row->addStretch(1);
    auto* text = dimLabel({});
    const auto show = [=, this] {
        QString words = hint;
        for (const ActionId id : keys) {
            const QString key = mActions[id]->shortcut().toString(QKeySequence::NativeText);
            words = words.arg(key.isEmpty() ? tr("(no key)") : key);
        }
        text->setText(words);
    };
    show();
    for (const ActionId id : keys) connect(mActions[id], &QAction::changed, text, show);
    text->setWordWrap(false);
    text->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    row->addWidget(text, 100);
    return {widget, row};
}

namespace {

// Before the stretch and the hint, which every page ends with.
void insert(QHBoxLayout* row, QWidget* widget) {
    row->insertWidget(row->count() - 2, widget);
}

void insertLabelled(QHBoxLayout* row, const QString& name, QWidget* field) {
    auto* label = new QLabel(name);
    label->setBuddy(field);
    field->setAccessibleName(name);
    insert(row, label);
    insert(row, field);
}

}  // namespace

void ToolOptionsBar::addNumber(const Page& page, const QString& name, const QString& tip,
                               const QString& suffix, double least, double most, double factor,
                               double& (*field)(ToolOptions&)) {
    auto* box = new QDoubleSpinBox;
    box->setToolTip(tip);
    box->setRange(least, most);
    box->setDecimals(most > 100 ? 1 : 0);
    box->setSuffix(suffix);
    box->setKeyboardTracking(false);
    insertLabelled(page.row, name, box);
    connect(box, &QDoubleSpinBox::valueChanged, this, [=, this](double value) {
        change([&](ToolOptions& options) { field(options) = value / factor; });
    });
    mFields.emplace_back([=](ToolOptions options) {
        const QSignalBlocker quiet(box);
        box->setValue(field(options) * factor);
    });
}

void ToolOptionsBar::addSwitch(const Page& page, const QString& name, const QString& tip,
                               bool& (*field)(ToolOptions&)) {
    auto* box = new QCheckBox(name);
    box->setToolTip(tip);
    insert(page.row, box);
    connect(box, &QCheckBox::toggled, this,
            [=, this](bool on) { change([&](ToolOptions& options) { field(options) = on; }); });
    mFields.emplace_back([=](ToolOptions options) {
        const QSignalBlocker quiet(box);
        box->setChecked(field(options));
    });
}

void ToolOptionsBar::addColour(const Page& page, const QString& name, glm::dvec3& (*field)(ToolOptions&)) {
    auto* colour = new ColourField(name);
    insertLabelled(page.row, name, colour);
    connect(colour, &ColourField::chosen, this,
            [=, this](glm::dvec3 srgb) { change([&](ToolOptions& options) { field(options) = srgb; }); });
    mFields.emplace_back([=](ToolOptions options) { colour->setColour(field(options)); });
}

void ToolOptionsBar::addSource(const Page& page) {
    auto* box = new QComboBox;
    box->addItem(tr("Vector image"));
    box->addItem(tr("Original photo"));
    box->setToolTip(tr("Which picture colours are taken from"));
    insertLabelled(page.row, tr("Pick from"), box);
    connect(box, &QComboBox::currentIndexChanged, this, [this](int index) {
        change([&](ToolOptions& options) {
            options.eyedropper = index == 0 ? ColourSource::Vector : ColourSource::Original;
        });
    });
    mFields.emplace_back([box](const ToolOptions& options) {
        const QSignalBlocker quiet(box);
        box->setCurrentIndex(options.eyedropper == ColourSource::Vector ? 0 : 1);
    });
}

void ToolOptionsBar::change(const std::function<void(ToolOptions&)>& edit) {
    ToolOptions options = mTools.options();
    edit(options);
    mTools.setOptions(options);
}

void ToolOptionsBar::refresh() {
    for (const auto& show : mFields) show(mTools.options());
}

}  // namespace tessera
