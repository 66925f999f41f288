// Pictures made from a formula.
#pragma once

#include "core/image/image.h"

namespace tessera::testing {

// The picture whose pixel at centre (x, y) has value(x, y, channel).
template <class Value>
Image paint(int width, int height, int channels, Value&& value) {
    Image image(width, height, channels);
    for (int c = 0; c < channels; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) image.at(x, y, c) = float(value(x + .5, y + .5, c));
    return image;
}

}  // namespace tessera::testing
