// See cli_bench_shapes.h.
#include "app/cli_bench_shapes.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>

#include "core/base/check.h"
#include "core/base/parallel.h"

namespace tessera::cli {

namespace {

using Colour = glm::dvec3;
// The colour at a point of the unit square.
using Shape = Colour (*)(glm::dvec2);

// Flat discs of several sizes, some of which overlap, on a flat ground.
Colour discs(glm::dvec2 p) {
    struct Disc {
        glm::dvec2 centre;
        double radius;
        Colour colour;
    };
    static constexpr std::array<Disc, 6> kDiscs{{{{.28, .30}, .20, {.85, .25, .20}},
                                                 {{.70, .27}, .13, {.15, .35, .75}},
                                                 {{.72, .70}, .22, {.95, .80, .25}},
                                                 {{.60, .60}, .10, {.10, .55, .35}},
                                                 {{.25, .75}, .08, {.20, .20, .25}},
                                                 {{.42, .84}, .04, {.60, .20, .60}}}};
    Colour colour{.90, .88, .84};
    for (const Disc& disc : kDiscs)
        if (glm::distance(p, disc.centre) < disc.radius) colour = disc.colour;
    return colour;
}

// Flat regions between borders of changing curvature, closed and open.
Colour borders(glm::dvec2 p) {
    const double wave = .30 + .10 * std::sin(7 * p.x) + .03 * std::sin(19 * p.x);
    const double slope = .72 + .08 * std::cos(5 * p.x + 1);
    Colour colour{.75, .45, .30};
    if (p.y < wave) colour = {.35, .60, .85};
    if (p.y > slope) colour = {.20, .40, .20};
    const glm::dvec2 d = p - glm::dvec2(.55, .5);
    const double flower = .17 + .04 * std::cos(5 * std::atan2(d.y, d.x));
    if (glm::length(d) < flower) colour = {.95, .92, .60};
    return colour;
}

// Smooth changes of colour inside of sharp borders.
Colour gradients(glm::dvec2 p) {
    Colour colour = glm::mix(Colour(.20, .30, .55), Colour(.85, .75, .65), p.y);
    const double disc = glm::distance(p, glm::dvec2(.35, .42));
    if (disc < .24) colour = glm::mix(Colour(1, .9, .7), Colour(.6, .15, .10), disc / .24);
    const glm::dvec2 d = (p - glm::dvec2(.68, .66)) / glm::dvec2(.24, .15);
    if (glm::dot(d, d) < 1) colour = glm::mix(Colour(.10, .45, .30), Colour(.70, .95, .60), .5 + .5 * d.x);
    return colour;
}

const std::map<std::string, Shape>& shapes() {
    static const std::map<std::string, Shape> table{
        {"borders", borders}, {"discs", discs}, {"gradients", gradients}};
    return table;
}

Colour pixel(Shape shape, int x, int y) {
    Colour sum(0);
    for (int j = 0; j < kShapeSamplesPerSide; ++j)
        for (int i = 0; i < kShapeSamplesPerSide; ++i) {
            const glm::dvec2 inside = (glm::dvec2(i, j) + .5) / double(kShapeSamplesPerSide);
            sum += shape((glm::dvec2(x, y) + inside) / double(kShapeSidePx));
        }
    return sum / double(kShapeSamplesPerSide * kShapeSamplesPerSide);
}

}  // namespace

const std::vector<std::string>& shapeNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const auto& [name, shape] : shapes()) all.push_back(name);
        return all;
    }();
    return names;
}

Image drawShape(const std::string& name) {
    const auto shape = shapes().find(name);
    TESSERA_CHECK(shape != shapes().end());
    Image image(kShapeSidePx, kShapeSidePx, 3);
    parallelFor(kShapeSidePx, 8, [&](size_t begin, size_t end) {
        for (int y = int(begin); y < int(end); ++y)
            for (int x = 0; x < kShapeSidePx; ++x) {
                const Colour colour = pixel(shape->second, x, y);
                for (int c = 0; c < 3; ++c) image.at(x, y, c) = float(colour[c]);
            }
    });
    return image;
}

}  // namespace tessera::cli
