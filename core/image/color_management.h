// From a picture's own colours to gamma-encoded sRGB, without clipping; ICC profiles through lcms2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tessera {

// sRGB's transfer curve (IEC 61966-2-1) and its inverse, odd-symmetric about 0 and continued beyond 1.
float encodeSrgb(float linear);
float decodeSrgb(float encoded);

enum class ColorModel { Grey, Rgb, Cmyk };

// How many samples a pixel of this model has, alpha not counted.
size_t sampleCount(ColorModel model);

// What to do with the samples of a source. Safe to use from several threads at once.
class ColorConverter {
  public:
    // Samples that are sRGB already; CMYK by the rule of thumb (1 - ink) * (1 - black).
    static ColorConverter plain(ColorModel model);
    // Samples proportional to light^(1 / gamma) with sRGB's primaries; gamma 1 is linear light.
    static ColorConverter power(ColorModel model, double gamma);
    // Linear light with the primaries and white point x, y of R, G, B and W.
    static ColorConverter linearPrimaries(ColorModel model, const std::array<double, 8>& chromaticities);
    // By an ICC profile, relative colorimetric (CMYK with black point compensation, as paper's black is not
    // screen's). Plain where lcms2 cannot use the profile for such samples, and where the profile is sRGB but
    // for rounding: most profiles in photographs are, and their pixels then stay what they were.
    static ColorConverter profile(ColorModel model, std::span<const uint8_t> icc);

    // `samples` holds `count` pixels of sampleCount floats, 0..1 (CMYK: amount of ink), and may be
    // overwritten; `rgb` receives 3 floats a pixel. Grey pixels come out with three equal channels.
    void convert(std::span<float> samples, size_t count, std::span<float> rgb) const;

  private:
    enum class Kind { Plain, Power, Profile };

    bool changesNothing() const;

    Kind mKind = Kind::Plain;
    ColorModel mModel = ColorModel::Rgb;
    double mGamma = 1;
    bool mExpandGrey = false;          // the profile wants grey as three equal channels
    std::shared_ptr<void> mTransform;  // lcms2's, to linear light with sRGB's primaries
};

// The way back: from gamma-encoded sRGB to the samples of an ICC profile, relative colorimetric.
class ProfileTarget {
  public:
    // None where `icc` is no profile of an RGB space that can be written to.
    static std::optional<ProfileTarget> of(std::span<const uint8_t> icc);

    // Pixels of three values, changed in place. Safe to use from several threads at once.
    void convert(std::span<float> rgb) const;

  private:
    std::shared_ptr<void> mTransform;  // lcms2's, from linear light with sRGB's primaries
};

// A profile of sRGB to embed in files that have no other way to say so; the same bytes at every call.
std::vector<uint8_t> srgbProfile();

}  // namespace tessera
