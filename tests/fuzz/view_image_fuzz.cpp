// Any bytes as a picture of a view: taken as what they are or refused with a sentence; an SVG that is taken has no script in it.
#include <cstdlib>
#include <string>

#include "hmi_bridge/views/image_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace taktwerk;
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    const auto image = hmi::judge_image(bytes);
    if (!image) {
        if (image.error().what.empty() || image.error().remedy.empty()) std::abort();
        return 0;
    }
    if (image->bytes != bytes || bytes.size() > hmi::largest_image) std::abort();
    if (image->type == "image/svg+xml" && (bytes.find("<script") != std::string::npos || bytes.find("javascript:") != std::string::npos))
        std::abort();
    return 0;
}
