// Any bytes as a program's file: what is called a shared object has all that dlopen would map of it inside the file.
#include <elf.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>

#include "runtime/tasks/shared_object_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const int file = ::memfd_create("fuzz", MFD_CLOEXEC);
    static const std::string path = "/proc/self/fd/" + std::to_string(file);
    if (file < 0 || ::ftruncate(file, 0) != 0 || ::pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) std::abort();
    const auto checked = taktwerk::runtime::check_shared_object(path);
    if (!checked) {
        if (checked.error().what.empty()) std::abort();
        return 0;
    }
    if (const auto id = taktwerk::runtime::build_id_of(path);
        id.size() > 80 || id.find_first_not_of("0123456789abcdef") != std::string::npos)
        std::abort();
    Elf64_Ehdr header{};
    if (size < sizeof header) std::abort();
    std::memcpy(&header, data, sizeof header);
    for (std::size_t i = 0; i < header.e_phnum; ++i) {
        Elf64_Phdr segment{};
        if (header.e_phoff > size || size - header.e_phoff < (i + 1) * sizeof segment) std::abort();
        std::memcpy(&segment, data + header.e_phoff + i * sizeof segment, sizeof segment);
        if (segment.p_type == PT_LOAD && (segment.p_offset > size || segment.p_filesz > size - segment.p_offset)) std::abort();
    }
    return 0;
}
