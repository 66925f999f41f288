// Soft features: what EdgeBlur::terms and addBlur do (core/mesh/edge_blur.h), for the samples of one pixel
// that are one patch's. Lengths are image pixels; positions count from the first control point of the feature
// at hand, so that they stay small.

const float kBlurReach = 3.0;  // blur_profile.h
const float kBlurFade = 4.0;
const float kEvenSpan = 0.3;
const int kNewtonSteps = 5;
const float kNewtonEnough = 1e-4;
const int kMaxBlurTerms = 4;
const float kNearer = 1.0 - 1.0 / 2048.0;  // of a chain's features a later one must be
const float kSameFoot = 0.05;  // feet that are this near in t may share a place

float fade3(float from, float to, float x) {
    const float t = clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Phi(-x) brought to 0 between 2 and kBlurReach. (Abramowitz and Stegun 7.1.26: within 1.5e-7.)
float blurShare(float x) {
    const float z = 0.70710678119 * x, t = 1.0 / (1.0 + 0.3275911 * z);
    const float tail =
        t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
    return 0.5 * tail * exp(-z * z) * (1.0 - fade3(2.0, kBlurReach, x));
}

// The nearest point of the segment from `from` along `along`: its share of the segment, and the square of its
// distance.
vec2 nearestOnSegment(vec2 from, vec2 along, vec2 at) {
    const vec2 to = at - from;
    const float squared = dot(along, along);
    const float s = squared > 0.0 ? clamp(dot(to, along) / squared, 0.0, 1.0) : 0.0;
    const vec2 off = to - s * along;
    return vec2(s, dot(off, off));
}

struct Foot {
    float t;
    float distance;
    vec2 off;  // from the foot to the point
};

// A feature's curve in powers of t, from its first control point.
struct FeatureCurve {
    vec2 c1, c2, c3;
};

FeatureCurve featureCurve(uint f, ivec4 ends) {
    const ivec4 inner = loadFeatureInner(f);
    const float pixel = 1.0 / 256.0;
    const vec2 a = vec2(inner.xy - ends.xy) * pixel, b = vec2(inner.zw - ends.xy) * pixel,
               c = vec2(ends.zw - ends.xy) * pixel;
    return FeatureCurve(3.0 * a, 3.0 * (b - 2.0 * a), c - 3.0 * (b - a));
}

vec2 curveTangent(FeatureCurve c, float t) {
    return c.c1 + t * (2.0 * c.c2 + 3.0 * t * c.c3);
}

// Newton's method for the foot of `at`, between lo and hi.
float refinedFoot(FeatureCurve c, vec2 at, float t, float lo, float hi) {
    for (int i = 0; i < kNewtonSteps; ++i) {
        const vec2 r = t * (c.c1 + t * (c.c2 + t * c.c3)) - at, d = curveTangent(c, t),
                   d2 = 2.0 * c.c2 + 6.0 * t * c.c3;
        const float speed = dot(d, d), slope = speed + dot(r, d2), divisor = slope > 0.1 * speed ? slope : speed;
        if (divisor <= 0.0) return t;
        const float moved = clamp(t - dot(r, d) / divisor, lo, hi);
        const bool enough = abs(moved - t) < kNewtonEnough;
        t = moved;
        if (enough) break;
    }
    return t;
}

void takeNearer(FeatureCurve c, vec2 at, float t, inout Foot foot) {
    const vec2 off = at - t * (c.c1 + t * (c.c2 + t * c.c3));
    const float distance = length(off);
    if (distance < foot.distance) foot = Foot(t, distance, off);
}

// Whether feature f has a point nearer than foot.distance to `at`, by more than rounding; then that is the new
// foot.
bool findFoot(uint f, FeatureCurve c, FeatureBounds bounds, bool even, vec2 at, inout Foot foot) {
    const vec2 base = c.c1 + c.c2 + c.c3;
    const vec2 onBase = nearestOnSegment(vec2(0.0), base, at);
    const float limit = foot.distance + bounds.bend;
    if (onBase.y >= limit * limit) return false;
    float t = onBase.x;
    float span = kEvenSpan;
    if (!even) {
        span = 1.0 / float(kFeatureSegments);
        float best = 1e30;
        vec2 from = vec2(0.0);
        for (int i = 0; i < kFeatureSegments; ++i) {
            const vec4 ends = loadFeatureChords(f, i >> 1);
            const vec2 to = (i & 1) == 0 ? ends.xy : ends.zw;
            const vec2 onChord = nearestOnSegment(from, to - from, at);
            from = to;
            if (onChord.y >= best) continue;
            best = onChord.y;
            t = (float(i) + onChord.x) * span;
        }
        const float chordLimit = foot.distance + bounds.flatness;
        if (best >= chordLimit * chordLimit) return false;
    }
    const float enough = kNearer * foot.distance;
    Foot found = Foot(0.0, enough, vec2(0.0));
    takeNearer(c, at, refinedFoot(c, at, t, max(0.0, t - span), min(1.0, t + span)), found);
    takeNearer(c, at, t, found);  // Newton's method may leave for a worse place
    if (found.distance >= enough) return false;
    foot = found;
    return true;
}

float featureSigma(uint f, float t) {
    const vec2 sigma = loadFeatureSigma(f);
    return sigma.x + t * (sigma.y - sigma.x);
}

float blurWeight(uint f, Foot foot) {
    const float sigma = featureSigma(f, foot.t);
    if (sigma <= 0.0 || foot.distance >= kBlurReach * sigma) return 0.0;
    const float s = foot.t * float(kFeatureSegments);
    const int i = min(int(s), kFeatureSegments - 1);
    const uint flags = loadFeatureFlags(f);
    float toEnd = 1e30;
    if ((flags & (kFadesAtBegin | kFadesAtEnd)) != 0u) {
        const float before = loadFeatureArc(f, i), arc = before + (s - float(i)) * (loadFeatureArc(f, i + 1) - before);
        if ((flags & kFadesAtBegin) != 0u) toEnd = arc;
        if ((flags & kFadesAtEnd) != 0u) toEnd = min(toEnd, loadFeatureBounds(f).chainLength - arc);
    }
    return blurShare(foot.distance / sigma) * fade3(0.0, kBlurFade * sigma, toEnd);
}

// 0 left, 1 right.
int sideOf(uint f, uint reach, uint p, uvec2 beside, Foot foot) {
    if (p == beside.x) return 0;
    if (p == beside.y) return 1;
    const bool left = (reach & kReachFromLeft) != 0u, right = (reach & kReachFromRight) != 0u;
    if (left != right) return left ? 0 : 1;
    const vec4 ends = loadFeatureEndTangents(f);
    const vec2 tangent = foot.t <= 0.0   ? ends.xy
                         : foot.t >= 1.0 ? ends.zw
                                         : curveTangent(featureCurve(f, loadFeatureEnds(f)), foot.t);
    return tangent.x * foot.off.y - tangent.y * foot.off.x > 0.0 ? 0 : 1;
}

// The foot's point in the domain of the patch on `side`.
vec2 featureDomainPoint(uint f, int side, float t) {
    const uint corner = loadFeatureFlags(f) >> (kSideShift + 2u * uint(side)) & 3u;
    const float to = side == 0 ? t : 1.0 - t;
    const vec2 vw = corner == 0u ? vec2(to, 0.0) : corner == 1u ? vec2(1.0 - to, to) : vec2(0.0, 1.0 - to);
    return domainPoint(vw);
}

// A chain's term of the samples together: their weights' sum, and the place of the heaviest.
struct BlurTerm {
    float weight;
    uint reach;  // as in `reaches`
    Foot foot;
    bool mixed;  // the samples are nearest to several features: one place does not stand for all
};

// How far beyond the reach of its chain a feature is from a point, in squares: below 0 wherever it may matter.
// Wrong on the safe side (EdgeBlur::findNear).
float excessOf(ivec4 ends, FeatureBounds bounds, float slack, vec2 at) {
    const float limit = bounds.reach + bounds.bend + slack;
    return nearestOnSegment(vec2(0.0), vec2(ends.zw - ends.xy) / 256.0, at - imagePoint(ends.xy)).y - limit * limit;
}

// The term of the chain whose reaches begin at `i`, which is moved past them; `middle` is a point within `slack`
// of all samples.
BlurTerm chainTerm(uint end, vec2 samples[SAMPLES], uint mask, vec2 middle, float slack, inout uint i) {
    const uint chain = loadFeatureChain(loadReach(i) & kReachFeature);
    Foot feet[SAMPLES];
    uint nearest[SAMPLES];
    for (int s = 0; s < SAMPLES; ++s) {
        feet[s] = Foot(0.0, 1e30, vec2(0.0));
        nearest[s] = kNoPatch;
    }
    for (; i < end; ++i) {
        const uint reach = loadReach(i), f = reach & kReachFeature;
        const uint flags = loadFeatureFlags(f);
        if (loadFeatureChain(f) != chain) break;
        const ivec4 ends = loadFeatureEnds(f);
        const FeatureBounds bounds = loadFeatureBounds(f);
        if (excessOf(ends, bounds, slack, middle) >= 0.0) continue;
        const FeatureCurve c = featureCurve(f, ends);
        const vec2 from = imagePoint(ends.xy);
        for (int s = 0; s < SAMPLES; ++s) {
            if ((mask >> s & 1u) == 0u) continue;
            feet[s].distance = min(feet[s].distance, bounds.reach);
            if (findFoot(f, c, bounds, (flags & kEven) != 0u, samples[s] - from, feet[s])) nearest[s] = reach;
        }
    }
    BlurTerm term = BlurTerm(0.0, kNoPatch, feet[0], false);
    float heaviest = 0.0, moment = 0.0;
    for (int s = 0; s < SAMPLES; ++s) {
        if (nearest[s] == kNoPatch) continue;
        const float weight = blurWeight(nearest[s] & kReachFeature, feet[s]);
        if (weight <= 0.0) continue;
        term.mixed = term.mixed || (term.weight > 0.0 && (nearest[s] != term.reach || abs(feet[s].t - term.foot.t) > kSameFoot));
        term.weight += weight;
        moment += weight * feet[s].t;
        if (weight <= heaviest) continue;
        heaviest = weight;
        term.reach = nearest[s];
        term.foot = feet[s];
    }
    // Where the jump is linear along the curve, its weighted sum is that of one place.
    if (term.weight > 0.0 && !term.mixed) term.foot.t = moment / term.weight;
    return term;
}

vec4 jumpOf(BlurTerm term, uint p) {
    const uint f = term.reach & kReachFeature;
    const uvec2 beside = loadFeaturePatches(f);
    const int own = sideOf(f, term.reach, p, beside, term.foot);
    const vec2 beyond = featureDomainPoint(f, 1 - own, term.foot.t), here = featureDomainPoint(f, own, term.foot.t);
    return evaluateSpline(beside[1 - own], beyond) -
           evaluateSpline(beside[own], here);
}

// The sum over the samples in `mask` of what the reaches [first, end) add to the colour of patch p, or `mixed`.
vec4 blurOfGroup(uint p, uint first, uint end, vec2 samples[SAMPLES], uint mask, vec2 middle, float slack,
                 out bool mixed) {
    BlurTerm terms[kMaxBlurTerms];
    int count = 0;
    mixed = false;
    for (uint i = first; i < end;) {
        const BlurTerm term = chainTerm(end, samples, mask, middle, slack, i);
        mixed = mixed || term.mixed;
        if (term.weight <= 0.0) continue;
        int slot = count;
        if (count == kMaxBlurTerms) {
            slot = 0;
            for (int k = 1; k < kMaxBlurTerms; ++k)
                if (terms[k].weight < terms[slot].weight) slot = k;
            if (terms[slot].weight >= term.weight) continue;
        } else {
            ++count;
        }
        terms[slot] = term;
    }
    vec4 sum = vec4(0.0);
    if (mixed) return sum;
    for (int k = 0; k < count; ++k) sum += terms[k].weight * jumpOf(terms[k], p);
    return sum;
}

// The sum over the samples in `mask` of what blurred features add to the colour of patch p; samples in image
// pixels from the view's corner, none farther than `slack` from `middle`.
vec4 blurOf(uint p, vec2 samples[SAMPLES], uint mask, vec2 middle, float slack) {
    const uvec2 list = loadReachList(p);
    const uint end = list.x + list.y;
    uint first = list.x;
    for (; first < end; ++first) {
        const uint f = loadReach(first) & kReachFeature;
        if (excessOf(loadFeatureEnds(f), loadFeatureBounds(f), slack, middle) < 0.0) break;
    }
    // The features of a chain that lie before are out of reach. All samples together, or one by one.
    vec4 sum = vec4(0.0);
    uint left = first < end ? mask : 0u, group = mask;
    while (left != 0u) {
        bool mixed;
        const vec4 part = blurOfGroup(p, first, end, samples, group, middle, slack, mixed);
        if (!mixed) {
            sum += part;
            left &= ~group;
        }
        group = left & -left;
    }
    return sum;
}
