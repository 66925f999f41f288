#version 450 core
// Colours from the visibility buffer: one evaluation of a spline for each patch that a pixel's samples are of,
// at their middle; more only where features are blurred. Working space, not clamped, premultiplied.
// SAMPLES is 1 or 4; BLUR is defined where features may be blurred; COUNT_EVALUATIONS adds up how many splines
// were evaluated.
#include "include/gpu_layout.glsl"
#include "include/geometry.glsl"

layout(binding = 0) uniform usampler2D visibility;
layout(location = 0) out vec4 colour;

#ifdef COUNT_EVALUATIONS
layout(std430, binding = 0) buffer CounterBuffer { uint counters[2]; };  // outside blur, for blur
uint evaluations = 0u;
void countEvaluation() {
    ++evaluations;
}
#else
void countEvaluation() {}
#endif

// Image pixels from the view's corner.
vec2 imagePoint(ivec2 lattice) {
    return (vec2(lattice - view.origin) - view.fraction) / 256.0;
}
vec2 imagePoint(vec2 grid) {
    return grid / (view.gridPerUnit * 256.0);
}

#include "include/tps.glsl"
#ifdef BLUR
#include "include/blur.glsl"
#endif

const int kRefinements = 3;
const float kRefined = 0.01;  // samples

// The mean parameters of points of the shape whose mean is `grid`, from ones nearby; `spread` are the second moments
// (vv, ww, vw) of their parameters.
vec2 refinedParameters(PatchShape shape, vec2 grid, vec2 vw, vec3 spread) {
    ivec2 lattice[10];
    loadControlPoints(shape, lattice);
    vec2 b[10];
    for (int i = 0; i < 10; ++i) b[i] = toGrid(lattice[i]);
    for (int step = 0; step < kRefinements; ++step) {
        const float v = vw.x, w = vw.y, u = 1.0 - v - w;
        // The quadratic forms at the corners of one step of de Casteljau's algorithm.
        const vec2 qa = u * u * b[0] + v * v * b[2] + w * w * b[7] + 2.0 * (u * v * b[1] + u * w * b[8] + v * w * b[9]);
        const vec2 qb = u * u * b[1] + v * v * b[3] + w * w * b[5] + 2.0 * (u * v * b[2] + u * w * b[9] + v * w * b[4]);
        const vec2 qc = u * u * b[8] + v * v * b[4] + w * w * b[6] + 2.0 * (u * v * b[9] + u * w * b[7] + v * w * b[5]);
        const vec2 off = grid - (u * qa + v * qb + w * qc);
        const vec2 dv = 3.0 * (qb - qa), dw = 3.0 * (qc - qa);
        const float area = dv.x * dw.y - dv.y * dw.x;
        if (area == 0.0) break;
        vw += vec2(off.x * dw.y - off.y * dw.x, dv.x * off.y - dv.y * off.x) / area;
        if (dot(off, off) >= kRefined) continue;
#if SAMPLES > 1
        // The map's second derivatives move the mean.
        const vec2 a = u * b[0] + v * b[1] + w * b[8], ab = u * b[1] + v * b[2] + w * b[9],
                   ac = u * b[8] + v * b[9] + w * b[7];
        const vec2 dvv = a - 2.0 * ab + u * b[2] + v * b[3] + w * b[4],
                   dww = a - 2.0 * ac + u * b[7] + v * b[5] + w * b[6],
                   dvw = a - ab - ac + u * b[9] + v * b[4] + w * b[5];
        const vec2 moved = 3.0 * (spread.x * dvv + spread.y * dww + 2.0 * spread.z * dvw);
        vw -= vec2(moved.x * dw.y - moved.y * dw.x, dv.x * moved.y - dv.y * moved.x) / area;
#endif
        break;
    }
    return vw;
}

vec2 clampedToDomain(vec2 vw) {
    const vec3 b = max(vec3(1.0 - vw.x - vw.y, vw), vec3(0.0));
    return b.yz / (b.x + b.y + b.z);
}

// Where a mean may be off by more than this, or a pixel is a good part of a patch (in second moments), a spline
// is evaluated for each sample.
const float kMostUnsure = 0.0025, kMostSpread = 0.02;

vec2 domainPointAt(uint p, vec2 grid, vec2 vw, vec3 spread) {
    const PatchShape shape = loadShape(p);
    if ((shape.flags & kAffine) == 0u) vw = refinedParameters(shape, grid, vw, spread);
    return domainPoint(clampedToDomain(vw));
}

// The sum of the patch's own colours at the samples in `mask`.
vec4 sumOfSplines(uint p, vec2 grid[SAMPLES], uvec2 visible[SAMPLES], uint mask) {
    vec2 middle = vec2(0.0), vw = vec2(0.0);
    for (int k = 0; k < SAMPLES; ++k) {
        if ((mask >> k & 1u) == 0u) continue;
        middle += grid[k];
        vw += unpackUnorm2x16(visible[k].y);
    }
    const float count = float(bitCount(mask));
    vw /= count;
    vec3 spread = vec3(0.0);
    for (int k = 0; k < SAMPLES; ++k) {
        if ((mask >> k & 1u) == 0u) continue;
        const vec2 off = unpackUnorm2x16(visible[k].y) - vw;
        spread += vec3(off * off, off.x * off.y);
    }
    spread /= count;
    if (spread.x + spread.y < kMostSpread) {
        const vec2 at = domainPointAt(p, middle / count, vw, spread);
        float unsure;
        const vec4 mean = evaluateSpline(p, SplinePlace(at, domainSpread(spread)), unsure);
        if (SAMPLES == 1 || unsure < kMostUnsure) return count * mean;
    }
    vec4 sum = vec4(0.0);
    for (int k = 0; k < SAMPLES; ++k)
        if ((mask >> k & 1u) != 0u)
            sum += evaluateSpline(p, domainPointAt(p, grid[k], unpackUnorm2x16(visible[k].y), vec3(0.0)));
    return sum;
}

// The sum of the colours of the samples in `mask`, which are all patch p's.
vec4 sumOfSamples(uint p, vec2 grid[SAMPLES], uvec2 visible[SAMPLES], vec2 samples[SAMPLES], uint mask) {
    vec4 sum = sumOfSplines(p, grid, visible, mask);
#ifdef COUNT_EVALUATIONS
    const uint before = evaluations;
#endif
#ifdef BLUR
    const vec2 pixel = imagePoint(vec2(1.0));  // of the grid
    const vec2 middle = SAMPLES == 1 ? samples[0] : 0.5 * (samples[0] + samples[SAMPLES - 1]);
    const float slack = SAMPLES == 1 ? 0.01 : 0.01 + 0.5 * length(pixel);
    sum += blurOf(p, samples, mask, middle, slack);
#endif
#ifdef COUNT_EVALUATIONS
    atomicAdd(counters[0], before);
    atomicAdd(counters[1], evaluations - before);
    evaluations = 0u;
#endif
    sum = toWorking(sum);
    if (view.channels == 3u) sum.w = float(bitCount(mask));
    return sum;
}

void main() {
    const ivec2 fromBelow = ivec2(gl_FragCoord.xy) - view.target;
    const int perSide = SAMPLES == 4 ? 2 : 1;
    const int rows = int(view.gridSize.y) / perSide;
    const ivec2 corner = perSide * ivec2(fromBelow.x, rows - 1 - fromBelow.y);
    uvec2 visible[SAMPLES];
    vec2 grid[SAMPLES], samples[SAMPLES];
    for (int s = 0; s < SAMPLES; ++s) {
        const ivec2 at = corner + ivec2(s & 1, s >> 1);
        visible[s] = texelFetch(visibility, at, 0).xy;
        grid[s] = vec2(at) + 0.5;
        samples[s] = imagePoint(grid[s]);
    }
    vec4 sum = vec4(0.0);
    uint done = 0u;
    for (int s = 0; s < SAMPLES; ++s) {
        const uint p = visible[s].x;
        if (p == kNoPatch || (done >> s & 1u) != 0u) continue;
        uint mask = 0u;
        for (int k = s; k < SAMPLES; ++k)
            if (visible[k].x == p) mask |= 1u << k;
        done |= mask;
        sum += sumOfSamples(p, grid, visible, samples, mask);
    }
    colour = sum / float(SAMPLES);
}
