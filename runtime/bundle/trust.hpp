#pragma once
// Whose bundles this computer takes: public keys in a folder, a file each. Without any it takes every bundle and says so. Not real-time.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "runtime/signature/signing_key.hpp"

namespace taktwerk::runtime {

inline constexpr const char* usual_trust_folder = "/etc/taktwerk/trusted-keys";
inline constexpr const char* public_key_ending = ".pub";

struct TrustedKey {
    std::string name;  ///< its file without the ending
    PublicKey key;
};

/// Who stands for a bundle.
struct Signer {
    enum class Kind {
        trusted,    ///< a trusted key has signed it
        unsigned_,  ///< nobody has signed it, and no key is trusted
        unjudged,   ///< somebody has signed it, and no key is trusted: nobody can say who
    };
    Kind kind = Kind::unsigned_;
    std::string name{};         ///< trusted: the key's name
    std::string fingerprint{};  ///< trusted: the key's
};
/// "signed by plant (0123456789abcdef)", "not signed", "signed, but no key is trusted here".
[[nodiscard]] std::string words_of(const Signer& signer);

class Trust {
public:
    explicit Trust(std::vector<TrustedKey> keys, std::string folder = {}) : keys_(std::move(keys)), folder_(std::move(folder)) {}
    /// All NAME.pub of the folder; none where there is no such folder. One that cannot be read or is no key, or a key with another ending, is an error: leaving
    /// it out could open the door that it was to close. Errors: trust.unreadable, key.not_public; trust.open (others may write the folder or a key).
    [[nodiscard]] static Result<Trust> read(const std::filesystem::path& folder);

    /// Errors: bundle.unsigned, bundle.foreign (no trusted key has signed this manifest, or it was changed since).
    [[nodiscard]] Result<Signer> judge(std::string_view manifest, const std::optional<std::string>& signature,
                                       const std::string& subject) const;
    [[nodiscard]] const std::vector<TrustedKey>& keys() const noexcept { return keys_; }

private:
    std::vector<TrustedKey> keys_;
    std::string folder_;
};

}  // namespace taktwerk::runtime
