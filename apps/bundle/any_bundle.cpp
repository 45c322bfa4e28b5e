#include "apps/bundle/any_bundle.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "runtime/bundle/active_bundle.hpp"
#include "runtime/bundle/durable.hpp"

namespace taktwerk::apps {

using namespace runtime;

Result<AnyBundle> AnyBundle::find(const std::string& named, const BundlePlaces& places) {
    AnyBundle out;
    std::error_code failed;
    const auto at = named.find('@');
    const bool name =
        is_bundle_name(std::string_view(named).substr(0, at)) && (at != std::string::npos || !std::filesystem::exists(named, failed));
    if (!name) {
        auto file = BundleFile::open(named, Trust({}));
        if (!file) return file.error();
        out.file_ = std::move(file).value();
        return out;
    }
    const auto store = places.store();
    const auto machine = named.substr(0, at);
    auto version = at == std::string::npos ? std::string{} : named.substr(at + 1);
    if (version.empty()) {
        const auto chain = activations_of(store, machine);
        if (!chain.empty()) version = chain.front().version;
        else if (!store.versions(machine).empty())
            return Error{"bundle.none_active", machine, "no version of it is active",
                         fmt::format("say which: {}@{}", machine, store.versions(machine).back())};
    }
    auto installed = store.find(machine, version);
    if (!installed) return installed.error();
    out.installed_ = std::move(installed).value();
    return out;
}

const Manifest& AnyBundle::manifest() const noexcept { return file_ ? file_->manifest() : installed_->manifest; }
const std::string& AnyBundle::manifest_text() const noexcept { return file_ ? file_->manifest_text() : installed_->manifest_text; }

std::string AnyBundle::signature_words(const Trust& trust) const {
    const auto judged = trust.judge(manifest_text(), file_ ? file_->signature() : installed_->signature, "");
    return judged                                     ? words_of(*judged)
           : judged.error().code == "bundle.unsigned" ? "not signed: refused here"
                                                      : "signed by nobody who is trusted here: refused";
}

Result<std::string> AnyBundle::content(const BundledFile& file) const {
    return file_ ? file_->content(file) : read_small_file(installed_->file(file.path), largest_packed_file);
}

}  // namespace taktwerk::apps
