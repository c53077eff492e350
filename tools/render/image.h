// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_IMAGE_H
#define OPENSUBDIVHEX_TOOLS_IMAGE_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief Pixels of 8-bit sRGB red, green and blue, row by row from the top; white at first.
struct Image {
    Image(int imageWidth, int imageHeight)
        : width(imageWidth), height(imageHeight),
          pixels(3 * std::size_t(imageWidth) * std::size_t(imageHeight), 255) {}

    std::uint8_t *GetPixel(int x, int y) {
        return pixels.data() + 3 * (std::size_t(y) * std::size_t(width) + std::size_t(x));
    }

    int width;
    int height;
    std::vector<std::uint8_t> pixels;
};

/// Copies \p source into \p image, to where its upper left corner comes to (\p left, \p top).
inline void PasteImage(Image const &source, int left, int top, Image *image) {
    std::size_t const rowSize = 3 * std::size_t(source.width);
    for (int y = 0; y < source.height; ++y) {
        std::copy_n(source.pixels.data() + std::size_t(y) * rowSize, rowSize,
                    image->GetPixel(left, top + y));
    }
}

} // namespace OpenSubdivHex::Tools

#endif
