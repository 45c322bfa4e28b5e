#include "runtime/tasks/shared_object_check.hpp"

#include <elf.h>

#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

namespace taktwerk::runtime {

namespace {

#if defined(__x86_64__)
constexpr std::uint16_t this_machine = EM_X86_64;
#elif defined(__aarch64__)
constexpr std::uint16_t this_machine = EM_AARCH64;
#else
#error "which ELF machine is this?"
#endif
static_assert(std::endian::native == std::endian::little);

constexpr const char* build_it_so = "build it with taktwerk_add_program() on a machine like this one";

template <class T>
bool read_at(std::ifstream& file, std::uint64_t offset, T& out) {
    file.seekg(static_cast<std::streamoff>(offset));
    return static_cast<bool>(file.read(reinterpret_cast<char*>(&out), sizeof(T)));
}

}  // namespace

Result<void> check_shared_object(const std::string& path) {
    const auto not_loadable = [&](std::string what, const char* remedy = build_it_so) {
        return Error{"program.not_loadable", path, std::move(what), remedy};
    };
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) return not_loadable(fmt::format("it cannot be read: {}", std::strerror(errno)), "correct its permissions, or `library:`");
    const auto size = static_cast<std::uint64_t>(file.tellg());

    Elf64_Ehdr header{};
    if (!read_at(file, 0, header) || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0)
        return not_loadable("it is no shared object: it does not begin as one");
    if (header.e_ident[EI_CLASS] != ELFCLASS64 || header.e_ident[EI_DATA] != ELFDATA2LSB || header.e_machine != this_machine)
        return not_loadable(fmt::format("it is built for another processor (ELF machine {}, here {})", header.e_machine, this_machine));
    if (header.e_type != ET_DYN || header.e_phentsize != sizeof(Elf64_Phdr))
        return not_loadable("it is no shared object but an object file, a program of its own, or the like");

    // The section headers stand last in the file: where they are missing, the file lost its end, even if all that is mapped is there.
    const auto sections = std::uint64_t{header.e_shnum} * header.e_shentsize;
    if (header.e_shoff != 0 && (sections > size || header.e_shoff > size - sections))
        return not_loadable(fmt::format("it is cut short: {} bytes are not all of it", size), "copy or build it again");
    for (std::uint16_t i = 0; i < header.e_phnum; ++i) {
        Elf64_Phdr segment{};
        if (!read_at(file, header.e_phoff + std::uint64_t{i} * sizeof segment, segment) ||
            (segment.p_type == PT_LOAD && (segment.p_filesz > size || segment.p_offset > size - segment.p_filesz)))
            return not_loadable(fmt::format("it is cut short: {} bytes are not all of it", size), "copy or build it again");
    }
    return {};
}

}  // namespace taktwerk::runtime
