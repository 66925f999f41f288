// See color_management.h.
#include "core/image/color_management.h"

#include <lcms2.h>

#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace tessera {

namespace {

using Profile = std::unique_ptr<void, cmsBool (*)(cmsHPROFILE)>;

Profile own(cmsHPROFILE profile) {
    return {profile, cmsCloseProfile};
}

Profile linearRgbProfile(const cmsCIExyY& white, const cmsCIExyYTRIPLE& primaries) {
    const std::unique_ptr<cmsToneCurve, void (*)(cmsToneCurve*)> line(cmsBuildGamma(nullptr, 1.0),
                                                                      cmsFreeToneCurve);
    cmsToneCurve* curves[3] = {line.get(), line.get(), line.get()};
    return own(cmsCreateRGBProfile(&white, &primaries, curves));
}

// The target is linear light: lcms2 continues sRGB's own curve below 0 by a straight line, where we want
// symmetry.
Profile linearSrgbProfile() {
    return linearRgbProfile({0.3127, 0.3290, 1}, {{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}});
}

// To samples of TYPE_RGB_FLT.
std::shared_ptr<void> makeTransform(const Profile& from, cmsUInt32Number type, const Profile& to,
                                    cmsUInt32Number flags) {
    if (!from || !to) return nullptr;
    // lcms2's cache of the last pixel is shared by threads.
    cmsHTRANSFORM transform = cmsCreateTransform(from.get(), type, to.get(), TYPE_RGB_FLT,
                                                 INTENT_RELATIVE_COLORIMETRIC, flags | cmsFLAGS_NOCACHE);
    return transform ? std::shared_ptr<void>(transform, cmsDeleteTransform) : nullptr;
}

std::shared_ptr<void> makeTransform(const Profile& from, cmsUInt32Number type, cmsUInt32Number flags) {
    return makeTransform(from, type, linearSrgbProfile(), flags);
}

float oddPower(float x, double exponent) {
    return float(std::copysign(std::pow(std::abs(double(x)), exponent), double(x)));
}

}  // namespace

float encodeSrgb(float linear) {
    const float x = std::abs(linear);
    return std::copysign(x <= .0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - .055f, linear);
}

float decodeSrgb(float encoded) {
    const float x = std::abs(encoded);
    return std::copysign(x <= .04045f ? x / 12.92f : std::pow((x + .055f) / 1.055f, 2.4f), encoded);
}

size_t sampleCount(ColorModel model) {
    switch (model) {
        case ColorModel::Grey:
            return 1;
        case ColorModel::Rgb:
            return 3;
        case ColorModel::Cmyk:
            return 4;
    }
    return 0;
}

ColorConverter ColorConverter::plain(ColorModel model) {
    ColorConverter converter;
    converter.mModel = model;
    return converter;
}

ColorConverter ColorConverter::power(ColorModel model, double gamma) {
    ColorConverter converter = plain(model);
    converter.mKind = Kind::Power;
    converter.mGamma = gamma;
    return converter;
}

ColorConverter ColorConverter::linearPrimaries(ColorModel model,
                                               const std::array<double, 8>& chromaticities) {
    const auto& c = chromaticities;
    const bool sensible = std::all_of(c.begin(), c.end(), [](double v) { return std::abs(v) < 10; }) &&
                          c[1] > 0 && c[3] > 0 && c[7] > 0;
    ColorConverter converter = power(model, 1);
    if (model != ColorModel::Rgb || !sensible) return converter;
    const Profile from =
        linearRgbProfile({c[6], c[7], 1}, {{c[0], c[1], 1}, {c[2], c[3], 1}, {c[4], c[5], 1}});
    converter.mTransform = makeTransform(from, TYPE_RGB_FLT, 0);
    if (converter.mTransform) converter.mKind = Kind::Profile;
    return converter;
}

ColorConverter ColorConverter::profile(ColorModel model, std::span<const uint8_t> icc) {
    ColorConverter converter = plain(model);
    const Profile from = own(cmsOpenProfileFromMem(icc.data(), cmsUInt32Number(icc.size())));
    if (!from) return converter;
    const cmsColorSpaceSignature space = cmsGetColorSpace(from.get());
    cmsUInt32Number type = 0;
    cmsUInt32Number flags = 0;
    if (model == ColorModel::Grey && space == cmsSigGrayData) type = TYPE_GRAY_FLT;
    if (model != ColorModel::Cmyk && space == cmsSigRgbData) type = TYPE_RGB_FLT;
    if (model == ColorModel::Cmyk && space == cmsSigCmykData) {
        type = TYPE_CMYK_FLT;
        flags = cmsFLAGS_BLACKPOINTCOMPENSATION;
    }
    if (type == 0) return converter;
    converter.mTransform = makeTransform(from, type, flags);
    converter.mExpandGrey = model == ColorModel::Grey && space == cmsSigRgbData;
    if (!converter.mTransform) return converter;
    converter.mKind = Kind::Profile;
    return converter.changesNothing() ? plain(model) : converter;
}

// Tried on a grid of colours: less than a quarter of an 8-bit step is rounding in the profile's 16-bit
// fractions.
bool ColorConverter::changesNothing() const {
    if (mModel != ColorModel::Rgb) return false;
    constexpr float kTolerance = .25f / 255;
    constexpr int kSteps = 12;
    std::vector<float> samples;
    for (int r = 0; r <= kSteps; ++r)
        for (int g = 0; g <= kSteps; ++g)
            for (int b = 0; b <= kSteps; ++b)
                for (const int step : {r, g, b}) samples.push_back(float(step) / kSteps);
    std::vector<float> rgb(samples.size());
    convert(samples, samples.size() / 3, rgb);
    return std::equal(rgb.begin(), rgb.end(), samples.begin(),
                      [](float a, float b) { return std::abs(a - b) <= kTolerance; });
}

void ColorConverter::convert(std::span<float> samples, size_t count, std::span<float> rgb) const {
    TESSERA_CHECK(samples.size() >= count * sampleCount(mModel) && rgb.size() >= count * 3);
    if (mKind != Kind::Profile) {
        for (size_t i = 0; i < count; ++i) {
            for (size_t c = 0; c < 3; ++c) {
                float value = 0;
                if (mModel == ColorModel::Grey) value = samples[i];
                if (mModel == ColorModel::Rgb) value = samples[3 * i + c];
                if (mModel == ColorModel::Cmyk) value = (1 - samples[4 * i + c]) * (1 - samples[4 * i + 3]);
                if (mKind == Kind::Power) value = encodeSrgb(mGamma == 1 ? value : oddPower(value, mGamma));
                rgb[3 * i + c] = value;
            }
        }
        return;
    }
    std::vector<float> expanded;
    const float* source = samples.data();
    if (mExpandGrey) {
        expanded.resize(3 * count);
        for (size_t i = 0; i < expanded.size(); ++i) expanded[i] = samples[i / 3];
        source = expanded.data();
    } else if (mModel == ColorModel::Cmyk) {
        for (float& ink : samples.first(4 * count)) ink *= 100;  // lcms2 wants inks in percent
    }
    cmsDoTransform(mTransform.get(), source, rgb.data(), cmsUInt32Number(count));
    for (size_t i = 0; i < count; ++i) {
        // A profile for grey may lead a little off the axis of greys, by rounding or by its white point.
        if (mModel == ColorModel::Grey) rgb[3 * i] = rgb[3 * i + 2] = rgb[3 * i + 1];
        for (size_t c = 0; c < 3; ++c) {
            const float value = rgb[3 * i + c];
            rgb[3 * i + c] = std::isfinite(value) ? encodeSrgb(value) : 0;
        }
    }
}

std::optional<ProfileTarget> ProfileTarget::of(std::span<const uint8_t> icc) {
    const Profile to = own(cmsOpenProfileFromMem(icc.data(), cmsUInt32Number(icc.size())));
    if (!to || cmsGetColorSpace(to.get()) != cmsSigRgbData) return {};
    ProfileTarget target;
    target.mTransform = makeTransform(linearSrgbProfile(), TYPE_RGB_FLT, to, 0);
    if (!target.mTransform) return {};
    return target;
}

void ProfileTarget::convert(std::span<float> rgb) const {
    for (float& value : rgb) value = decodeSrgb(value);
    cmsDoTransform(mTransform.get(), rgb.data(), rgb.data(), cmsUInt32Number(rgb.size() / 3));
}

std::vector<uint8_t> srgbProfile() {
    const Profile profile = own(cmsCreate_sRGBProfile());
    cmsUInt32Number size = 0;
    if (!profile || !cmsSaveProfileToMem(profile.get(), nullptr, &size)) return {};
    std::vector<uint8_t> bytes(size);
    if (!cmsSaveProfileToMem(profile.get(), bytes.data(), &size)) return {};
    // The header's time of creation: big-endian year, month, day, hour, minute, second.
    constexpr std::array<uint8_t, 12> kDate = {0x07, 0xd0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0};
    constexpr size_t kDateOffset = 24;
    if (bytes.size() >= kDateOffset + kDate.size())
        std::copy(kDate.begin(), kDate.end(), bytes.begin() + kDateOffset);
    return bytes;
}

}  // namespace tessera
