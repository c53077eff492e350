// SPDX-License-Identifier: Apache-2.0
#include "pngFile.h"

#include "tools/mesh/fileError.h"
#include "tools/mesh/outputFile.h"

#include <png.h>

#include <stdexcept>

namespace OpenSubdivHex::Tools {

std::string EncodePng(Image const &image) {
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    png.width = png_uint_32(image.width);
    png.height = png_uint_32(image.height);
    png.format = PNG_FORMAT_RGB;

    std::string content(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
    png_alloc_size_t size = content.size();
    if (!png_image_write_to_memory(&png, content.data(), &size, 0, image.pixels.data(), 0,
                                   nullptr)) {
        throw std::runtime_error(std::string("cannot be made: ") + png.message);
    }
    content.resize(size);
    return content;
}

void WritePng(Image const &image, std::string const &path) {
    std::string content;
    try {
        content = EncodePng(image);
    } catch (std::runtime_error const &error) {
        throw FileError(path, error.what());
    }
    OutputFile file(path);
    file.Write(content);
    file.Commit();
}

} // namespace OpenSubdivHex::Tools
