#include "apps/diag/tar.hpp"

#include "runtime/bundle/container.hpp"

namespace taktwerk::apps {
namespace {

constexpr std::size_t block = 512;

}  // namespace

std::string tar_member(std::string_view path, std::string_view bytes, std::int64_t seconds) {
    auto member = runtime::ustar_header(path, bytes.size(), seconds);
    member.append(bytes);
    member.append((block - bytes.size() % block) % block, '\0');
    return member;
}

std::string tar_end() { return std::string(2 * block, '\0'); }

}  // namespace taktwerk::apps
