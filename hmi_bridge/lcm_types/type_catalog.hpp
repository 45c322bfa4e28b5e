#pragma once
// LCM types by fingerprint and by name. Not real-time.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "hmi_bridge/lcm_types/type_text.hpp"

namespace taktwerk::hmi {

class TypeCatalog {
public:
    /// All types of a .lcm text. Errors: lcm.type_text.
    [[nodiscard]] Result<void> add(std::string_view text, const std::string& file);
    /// "package.name"; nullptr: none.
    [[nodiscard]] const LcmType* find(std::string_view full_name) const;
    /// nullptr: none, or one whose parts are not all here.
    [[nodiscard]] const LcmType* find(std::uint64_t fingerprint) const;
    /// The first eight bytes of each message, as lcm-gen computes it: names, types, order and dimensions of the fields, and not the name, the package and the
    /// constants. Nothing where a struct in it is not here.
    [[nodiscard]] std::optional<std::uint64_t> fingerprint(const LcmType& type) const;
    [[nodiscard]] const std::map<std::string, LcmType, std::less<>>& types() const noexcept { return types_; }

private:
    [[nodiscard]] std::optional<std::uint64_t> hash(const LcmType& type, std::vector<const LcmType*>& above, std::size_t& parts_left) const;

    std::map<std::string, LcmType, std::less<>> types_;
    mutable std::map<std::uint64_t, const LcmType*> by_fingerprint_;  // made when it is asked for
};

}  // namespace taktwerk::hmi
