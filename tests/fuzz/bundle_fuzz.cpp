// Any bytes as a bundle: refused with a reason, or files with paths that lead nowhere else, each inside of the bytes, each with the sum that is said of it.
// The first byte says what the rest is: 0 a bundle as it is, 1 a bundle whose headers get right check sums (or none but the whole ones would get
// through), 2 a manifest.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <set>
#include <string>

#include <fmt/format.h>

#include "runtime/bundle/bundle_file.hpp"

using namespace taktwerk;
using namespace taktwerk::runtime;

namespace {

class Bytes : public ByteSource {
public:
    explicit Bytes(std::string text) : text_(std::move(text)) {}
    [[nodiscard]] std::uint64_t size() const override { return text_.size(); }
    [[nodiscard]] Result<void> read(std::uint64_t offset, std::span<std::byte> into) const override {
        if (offset > text_.size() || into.size() > text_.size() - offset) std::abort();
        if (!into.empty()) std::memcpy(into.data(), text_.data() + offset, into.size());
        return {};
    }

private:
    std::string text_;
};

void put_sums_right(std::string& text) {
    constexpr std::size_t block = 512, sum_at = 148, sum_size = 8, magic_at = 257;
    for (std::size_t at = 0; at + block <= text.size(); at += block) {
        if (text.compare(at + magic_at, 5, "ustar") != 0) continue;
        text.replace(at + sum_at, sum_size, sum_size, ' ');
        unsigned sum = 0;
        for (std::size_t i = 0; i < block; ++i) sum += static_cast<unsigned char>(text[at + i]);
        text.replace(at + sum_at, sum_size, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
    }
}

void try_manifest(std::string_view text) {
    const auto manifest = manifest_of(text, "fuzz");
    if (!manifest) {
        if (manifest.error().what.empty() || manifest.error().remedy.empty()) std::abort();
        return;
    }
    if (!is_bundle_name(manifest->name) || !is_bundle_version(manifest->version)) std::abort();
    const auto written = text_of(*manifest);
    const auto again = manifest_of(written, "fuzz");
    if (!again || text_of(*again) != written) std::abort();
}

void try_bundle(const std::string& text) {
    std::set<std::string> seen;
    const Bytes bytes(text);
    if (const auto container = read_container(bytes, "fuzz"))
        for (const auto& file : container->files) {
            if (!is_packed_path(file.path) || file.path.front() == '/' || file.path.find("..") == 0 || !seen.insert(file.path).second)
                std::abort();
            if (file.offset > text.size() || file.size > text.size() - file.offset) std::abort();
        }
    const auto bundle = BundleFile::read(std::make_unique<Bytes>(text), "fuzz", Trust({}));
    if (!bundle) {
        if (bundle.error().what.empty() || bundle.error().remedy.empty()) std::abort();
        return;
    }
    try_manifest(bundle->manifest_text());
    for (const auto& file : bundle->manifest().files)
        if (const auto content = bundle->content(file); content && content->size() != file.size) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
    if (data[0] % 3 == 2) {
        try_manifest(text);
        return 0;
    }
    if (data[0] % 3 == 1) put_sums_right(text);
    try_bundle(text);
    return 0;
}
