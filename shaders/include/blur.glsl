// Soft features: what EdgeBlur::terms and addBlur do (core/mesh/edge_blur.h), for the samples of one pixel
// that are one patch's. Lengths are image pixels; positions count from the first control point of the feature
// at hand, so that they stay small.

const float kBlurReach = 3.0;  // blur_profile.h
const float kBlurFade = 4.0;
const float kEvenSpan = 0.3;
const int kNewtonSteps = 5;
const float kNewtonEnough = 1e-4;
const int kMaxBlurTerms = 4;

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

FeatureCurve featureCurve(uint f) {
    const ivec2 p0 = features[f].p[0];
    const float pixel = 1.0 / 256.0;
    const vec2 a = vec2(features[f].p[1] - p0) * pixel, b = vec2(features[f].p[2] - p0) * pixel,
               c = vec2(features[f].p[3] - p0) * pixel;
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

void takeNearer(FeatureCurve c, vec2 at, float t, inout Foot foot, inout bool nearer) {
    const vec2 off = at - t * (c.c1 + t * (c.c2 + t * c.c3));
    const float distance = length(off);
    if (distance >= foot.distance) return;
    foot = Foot(t, distance, off);
    nearer = true;
}

// Whether feature f has a point nearer than foot.distance to `at`; then that is the new foot.
bool findFoot(uint f, FeatureCurve c, vec2 at, inout Foot foot) {
    const vec2 base = c.c1 + c.c2 + c.c3;
    const vec2 onBase = nearestOnSegment(vec2(0.0), base, at);
    const float limit = foot.distance + features[f].bend;
    if (onBase.y >= limit * limit) return false;
    float t = onBase.x;
    float span = kEvenSpan;
    if ((features[f].flags & kEven) == 0u) {
        span = 1.0 / float(kFeatureSegments);
        float best = 1e30;
        for (int i = 0; i < kFeatureSegments; ++i) {
            const vec2 from = features[f].chords[i];
            const vec2 onChord = nearestOnSegment(from, features[f].chords[i + 1] - from, at);
            if (onChord.y >= best) continue;
            best = onChord.y;
            t = (float(i) + onChord.x) * span;
        }
        const float chordLimit = foot.distance + features[f].flatness;
        if (best >= chordLimit * chordLimit) return false;
    }
    bool nearer = false;
    takeNearer(c, at, refinedFoot(c, at, t, max(0.0, t - span), min(1.0, t + span)), foot, nearer);
    takeNearer(c, at, t, foot, nearer);  // Newton's method may leave for a worse place
    return nearer;
}

float featureSigma(uint f, float t) {
    return features[f].sigma[0] + t * (features[f].sigma[1] - features[f].sigma[0]);
}

float blurWeight(uint f, uint chain, Foot foot) {
    const float sigma = featureSigma(f, foot.t);
    if (sigma <= 0.0 || foot.distance >= kBlurReach * sigma) return 0.0;
    const float s = foot.t * float(kFeatureSegments);
    const int i = min(int(s), kFeatureSegments - 1);
    const float arc = features[f].arc[i] + (s - float(i)) * (features[f].arc[i + 1] - features[f].arc[i]);
    const uint fades = chains[chain].fades;
    const float toEnd = min((fades & kFadesAtBegin) != 0u ? arc : 1e30,
                            (fades & kFadesAtEnd) != 0u ? chains[chain].length - arc : 1e30);
    return blurShare(foot.distance / sigma) * fade3(0.0, kBlurFade * sigma, toEnd);
}

// 0 left, 1 right.
int sideOf(uint f, uint reach, uint p, FeatureCurve c, Foot foot) {
    if (p == features[f].patches[0]) return 0;
    if (p == features[f].patches[1]) return 1;
    const bool left = (reach & kReachFromLeft) != 0u, right = (reach & kReachFromRight) != 0u;
    if (left != right) return left ? 0 : 1;
    const vec2 tangent = foot.t <= 0.0   ? features[f].endTangents[0]
                         : foot.t >= 1.0 ? features[f].endTangents[1]
                                         : curveTangent(c, foot.t);
    return tangent.x * foot.off.y - tangent.y * foot.off.x > 0.0 ? 0 : 1;
}

// The foot's point in the domain of the patch on `side`.
vec2 featureDomainPoint(uint f, int side, float t) {
    const uint corner = features[f].flags >> (kSideShift + 2u * uint(side)) & 3u;
    const float to = side == 0 ? t : 1.0 - t;
    const vec2 vw = corner == 0u ? vec2(to, 0.0) : corner == 1u ? vec2(1.0 - to, to) : vec2(0.0, 1.0 - to);
    return domainPoint(vw);
}

// A chain's term of the samples together: their weights' sum, and the place of the heaviest.
struct BlurTerm {
    float weight;
    uint reach;  // as in `reaches`
    Foot foot;
};

// The term of the chain whose reaches begin at `i`, which is moved past them.
BlurTerm chainTerm(uint end, vec2 samples[SAMPLES], uint mask, inout uint i) {
    const uint chain = features[reaches[i] & kReachFeature].chain;
    Foot feet[SAMPLES];
    uint nearest[SAMPLES];
    for (int s = 0; s < SAMPLES; ++s) {
        feet[s] = Foot(0.0, (mask >> s & 1u) != 0u ? chains[chain].reach : -1e30, vec2(0.0));
        nearest[s] = kNoPatch;
    }
    for (; i < end; ++i) {
        const uint f = reaches[i] & kReachFeature;
        if (features[f].chain != chain) break;
        const FeatureCurve c = featureCurve(f);
        const vec2 from = imagePoint(features[f].p[0]);
        for (int s = 0; s < SAMPLES; ++s)
            if ((mask >> s & 1u) != 0u && findFoot(f, c, samples[s] - from, feet[s])) nearest[s] = reaches[i];
    }
    BlurTerm term = BlurTerm(0.0, kNoPatch, feet[0]);
    float heaviest = 0.0;
    for (int s = 0; s < SAMPLES; ++s) {
        if (nearest[s] == kNoPatch) continue;
        const float weight = blurWeight(nearest[s] & kReachFeature, chain, feet[s]);
        term.weight += weight;
        if (weight <= heaviest) continue;
        heaviest = weight;
        term.reach = nearest[s];
        term.foot = feet[s];
    }
    // The mean of the feet where they are on one curve.
    float t = 0.0, sum = 0.0;
    for (int s = 0; s < SAMPLES; ++s) {
        if (nearest[s] == kNoPatch || nearest[s] != term.reach) continue;
        t += feet[s].t;
        sum += 1.0;
    }
    if (sum > 0.0) term.foot.t = t / sum;
    return term;
}

vec4 jumpOf(BlurTerm term, uint p) {
    const uint f = term.reach & kReachFeature;
    const int own = sideOf(f, term.reach, p, featureCurve(f), term.foot);
    return evaluateSpline(features[f].patches[1 - own], featureDomainPoint(f, 1 - own, term.foot.t)) -
           evaluateSpline(features[f].patches[own], featureDomainPoint(f, own, term.foot.t));
}

// The sum over the samples in `mask` of what blurred features add to the colour of patch p; samples in image
// pixels from the view's corner.
vec4 blurOf(uint p, vec2 samples[SAMPLES], uint mask) {
    const ReachList list = reachLists[p];
    if (list.count == 0u) return vec4(0.0);
    BlurTerm terms[kMaxBlurTerms];
    int count = 0;
    for (uint i = list.first, end = list.first + list.count; i < end;) {
        const BlurTerm term = chainTerm(end, samples, mask, i);
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
    for (int k = 0; k < count; ++k) sum += terms[k].weight * jumpOf(terms[k], p);
    return sum;
}
