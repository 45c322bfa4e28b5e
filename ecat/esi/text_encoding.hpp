#pragma once
// The bytes of an XML file as UTF-8, whatever they were written in: by byte order mark, by the zeros of UTF-16, else by the encoding that
// the declaration names. Any bytes in. Not real-time.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::ecat::esi {

struct DecodedText {
    std::string utf8;                  ///< without byte order mark
    std::string encoding;              ///< the one that it was read as: "UTF-8", "ISO-8859-1"
    std::vector<std::string> remarks;  ///< such as bytes that are not of the encoding that the file declares
};

/// Errors: esi.encoding (an encoding that nobody here knows, or bytes that are not of it).
[[nodiscard]] Result<DecodedText> decode_text(std::span<const std::byte> bytes, const std::string& file);

}  // namespace taktwerk::ecat::esi
