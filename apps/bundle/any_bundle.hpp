#pragma once
// A bundle that a person names: a file, `cell@1.4.0`, or `cell` (its active version). Its files, whichever it is.

#include <optional>
#include <string>

#include "apps/bundle/commands.hpp"
#include "runtime/bundle/bundle_file.hpp"

namespace taktwerk::apps {

class AnyBundle {
public:
    /// Errors: those of BundleFile::open(), bundle.unknown, bundle.none_active.
    [[nodiscard]] static Result<AnyBundle> find(const std::string& named, const BundlePlaces& places);
    [[nodiscard]] const runtime::Manifest& manifest() const noexcept;
    [[nodiscard]] const std::string& manifest_text() const noexcept;
    /// Whether one of the trusted keys has signed it, in words.
    [[nodiscard]] std::string signature_words(const runtime::Trust& trust) const;
    /// Errors: bundle.sum, bundle.unreadable.
    [[nodiscard]] Result<std::string> content(const runtime::BundledFile& file) const;

private:
    std::optional<runtime::BundleFile> file_;
    std::optional<runtime::UnpackedBundle> installed_;
};

}  // namespace taktwerk::apps
