#pragma once
// Secrets in texts that leave the house: values of keys that are called so, and names with passwords in addresses. Pure.

#include <string>
#include <string_view>
#include <vector>

namespace taktwerk::apps {

struct Masked {
    std::string text;                ///< with `masked` in the place of each secret; otherwise as it was
    std::vector<std::string> where;  ///< "line 12: password"; never the secret
};

inline constexpr std::string_view mask = "<masked>";

/// Of YAML, JSON and logs, line by line: `password: x`, `"api_token": "x"`, `{psk: x, ...}`, the lines of a block (`secret: |`), `--password x`, and
/// `user:x@` in an address. A word in a comment or a longer name (`monkey`) is none.
[[nodiscard]] Masked masked(std::string_view text);

}  // namespace taktwerk::apps
