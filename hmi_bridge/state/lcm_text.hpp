#pragma once
// Texts of LCM messages end at their first NUL.

#include <algorithm>
#include <string>
#include <string_view>

namespace taktwerk::hmi {

/// Whatever a drive or a file said: with a NUL in it the whole message would not go out.
inline void put_text(std::string& to, std::string_view text) {
    to.assign(text);
    std::replace(to.begin(), to.end(), '\0', ' ');
}

}  // namespace taktwerk::hmi
