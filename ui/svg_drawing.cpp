// See svg_drawing.h.
#include "ui/svg_drawing.h"

#include <QPainter>
#include <QXmlStreamReader>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera {

namespace {

// The numbers and letters of a path, one after the other.
class PathTokens {
  public:
    explicit PathTokens(QStringView text) : mText(text) {}

    bool atEnd() {
        skipBlanks();
        return mText.isEmpty();
    }
    // The next command, where one stands there.
    std::optional<char> command() {
        if (atEnd() || !mText.front().isLetter()) return {};
        const char letter = mText.front().toLatin1();
        mText = mText.sliced(1);
        return letter;
    }
    std::optional<double> number() {
        skipBlanks();
        qsizetype length = 0;
        const auto belongs = [&](QChar c) {
            return c.isDigit() || c == u'.' || (length == 0 && (c == u'-' || c == u'+'));
        };
        while (length < mText.size() && belongs(mText[length])) ++length;
        bool isNumber = false;
        const double value = mText.first(length).toDouble(&isNumber);
        if (!isNumber) return {};
        mText = mText.sliced(length);
        return value;
    }
    // `count` numbers, or none.
    std::optional<std::vector<double>> numbers(int count) {
        std::vector<double> values;
        for (int i = 0; i < count; ++i) {
            const auto value = number();
            if (!value) return {};
            values.push_back(*value);
        }
        return values;
    }

  private:
    void skipBlanks() {
        while (!mText.isEmpty() && (mText.front().isSpace() || mText.front() == u','))
            mText = mText.sliced(1);
    }

    QStringView mText;
};

// An arc of a circle, from SVG's endpoint form to the centre form that QPainterPath takes.
void addArc(QPainterPath& path, double radius, bool large, bool clockwise, QPointF to) {
    const QPointF from = path.currentPosition();
    const QPointF half = (to - from) / 2;
    const double halfLength = std::hypot(half.x(), half.y());
    if (halfLength == 0) return;
    // As SVG asks: a circle too small to reach is enlarged until it does.
    const double r = std::max(radius, halfLength);
    const double toCentre = std::sqrt(r * r - halfLength * halfLength);
    const QPointF normal = QPointF(-half.y(), half.x()) / halfLength;
    const QPointF centre = from + half + normal * (large == clockwise ? -toCentre : toCentre);
    // Qt's angles run counterclockwise on the screen.
    const auto angle = [&](QPointF p) {
        return std::atan2(centre.y() - p.y(), p.x() - centre.x()) * 180 / std::numbers::pi;
    };
    double sweep = angle(to) - angle(from);
    if (clockwise && sweep > 0) sweep -= 360;
    if (!clockwise && sweep < 0) sweep += 360;
    path.arcTo(QRectF(centre.x() - r, centre.y() - r, 2 * r, 2 * r), angle(from), sweep);
}

int numberCount(char command) {
    switch (command) {
        case 'M':
        case 'L':
            return 2;
        case 'H':
        case 'V':
            return 1;
        case 'C':
            return 6;
        case 'A':
            return 7;
        default:
            return 0;
    }
}

// False for a command or numbers that are not understood.
bool addSegment(QPainterPath& path, char command, const std::vector<double>& v) {
    const QPointF at = path.currentPosition();
    switch (command) {
        case 'M':
            path.moveTo(v[0], v[1]);
            return true;
        case 'L':
            path.lineTo(v[0], v[1]);
            return true;
        case 'H':
            path.lineTo(v[0], at.y());
            return true;
        case 'V':
            path.lineTo(at.x(), v[0]);
            return true;
        case 'C':
            path.cubicTo(v[0], v[1], v[2], v[3], v[4], v[5]);
            return true;
        case 'A':
            if (v[0] != v[1] || v[2] != 0) return false;
            addArc(path, v[0], v[3] != 0, v[4] != 0, {v[5], v[6]});
            return true;
        case 'Z':
            path.closeSubpath();
            return true;
        default:
            return false;
    }
}

std::optional<QPainterPath> shapePath(const QString& element, const QXmlStreamAttributes& attributes) {
    const auto number = [&](const char* name) { return attributes.value(QLatin1String(name)).toDouble(); };
    if (element == "path") return readSvgPath(attributes.value("d"));
    QPainterPath path;
    if (element == "circle")
        path.addEllipse(QPointF(number("cx"), number("cy")), number("r"), number("r"));
    else if (element == "rect")
        path.addRoundedRect(QRectF(number("x"), number("y"), number("width"), number("height")), number("rx"),
                            number("rx"));
    else
        return {};
    return path;
}

}  // namespace

std::optional<QPainterPath> readSvgPath(QStringView d) {
    QPainterPath path;
    PathTokens tokens(d);
    while (!tokens.atEnd()) {
        const auto command = tokens.command();
        const auto values = command ? tokens.numbers(numberCount(*command)) : std::nullopt;
        if (!values || !addSegment(path, *command, *values)) return {};
    }
    return path;
}

std::optional<SvgDrawing> readSvgDrawing(const QByteArray& svg) {
    SvgDrawing drawing;
    QXmlStreamReader xml(svg);
    while (!xml.atEnd()) {
        if (xml.readNext() != QXmlStreamReader::StartElement) continue;
        const QXmlStreamAttributes attributes = xml.attributes();
        if (xml.name() == u"svg") {
            drawing.side = attributes.value("viewBox").split(u' ').value(2).toDouble();
            drawing.strokeWidth = attributes.value("stroke-width").toDouble();
            continue;
        }
        auto path = shapePath(xml.name().toString(), attributes);
        if (!path) return {};
        drawing.shapes.push_back(
            {.path = std::move(*path),
             .stroked = attributes.value("stroke") != u"none",
             .filled = attributes.value("fill") == u"currentColor",
             .opacity = attributes.hasAttribute("opacity") ? attributes.value("opacity").toDouble() : 1});
    }
    if (xml.hasError() || drawing.side <= 0 || drawing.strokeWidth <= 0) return {};
    return drawing;
}

void SvgDrawing::paint(QPainter& painter, const QRectF& target, const QColor& colour) const {
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.translate(target.topLeft());
    painter.scale(target.width() / side, target.height() / side);
    for (const Shape& shape : shapes) {
        painter.setOpacity(shape.opacity);
        painter.setPen(shape.stroked ? QPen(colour, strokeWidth, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin)
                                     : QPen(Qt::NoPen));
        painter.setBrush(shape.filled ? QBrush(colour) : QBrush(Qt::NoBrush));
        painter.drawPath(shape.path);
    }
    painter.restore();
}

}  // namespace tessera
