#include "runtime/tasks/shared_object_check.hpp"

#include <elf.h>

#include <array>
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
        return not_loadable(fmt::format("it is built for another processor (ELF machine {}{}{}, here {})", header.e_machine,
                                        header.e_ident[EI_CLASS] != ELFCLASS64 ? ", not of 64 bits" : "",
                                        header.e_ident[EI_DATA] != ELFDATA2LSB ? ", big-endian" : "", this_machine));
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

namespace {

/// The notes of one segment. Each begins, and its description too, at a multiple of `alignment` from the segment's beginning (gABI, "Note Section").
std::string build_id_in(std::ifstream& file, const Elf64_Phdr& segment, std::uint64_t alignment) {
    constexpr std::uint64_t longest_id = 40;
    constexpr std::uint32_t most_notes = 64;
    const auto aligned = [alignment](std::uint64_t at) { return (at + alignment - 1) / alignment * alignment; };
    std::uint64_t at = 0;
    for (std::uint32_t n = 0; n < most_notes && at < segment.p_filesz && segment.p_filesz - at >= sizeof(Elf64_Nhdr); ++n) {
        Elf64_Nhdr note{};
        if (!read_at(file, segment.p_offset + at, note)) return {};
        const auto name = at + sizeof note, description = aligned(name + note.n_namesz);
        at = aligned(description + note.n_descsz);
        std::array<char, 4> owner{};
        if (note.n_type != NT_GNU_BUILD_ID || note.n_namesz != owner.size() || note.n_descsz == 0 || note.n_descsz > longest_id ||
            !read_at(file, segment.p_offset + name, owner) || std::memcmp(owner.data(), ELF_NOTE_GNU, owner.size()) != 0)
            continue;
        std::string id;
        for (std::uint32_t k = 0; k < note.n_descsz; ++k) {
            unsigned char byte = 0;
            if (!read_at(file, segment.p_offset + description + k, byte)) return {};
            id += fmt::format("{:02x}", byte);
        }
        return id;
    }
    return {};
}

}  // namespace

std::string build_id_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    Elf64_Ehdr header{};
    if (!file || !read_at(file, 0, header)) return {};
    for (std::uint16_t i = 0; i < header.e_phnum; ++i) {
        Elf64_Phdr segment{};
        if (!read_at(file, header.e_phoff + std::uint64_t{i} * sizeof segment, segment)) return {};
        if (segment.p_type != PT_NOTE) continue;
        // A linker may put notes of 4 and of 8 into one segment, which then says 8 (mold does).
        for (const std::uint64_t alignment : {segment.p_align == 8 ? 8u : 4u, 4u})
            if (auto id = build_id_in(file, segment, alignment); !id.empty()) return id;
    }
    return {};
}

}  // namespace taktwerk::runtime
