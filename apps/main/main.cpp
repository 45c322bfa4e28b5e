#include <fcntl.h>
#include <unistd.h>

#include "apps/taktwerk.hpp"

namespace {

/// Started with one of the three closed, the next file that is opened would become standard output, and log lines would go into it.
void keep_standard_streams() {
    int file = ::open("/dev/null", O_RDWR);
    while (file >= 0 && file <= STDERR_FILENO) file = ::open("/dev/null", O_RDWR);
    if (file > STDERR_FILENO) ::close(file);
}

}  // namespace

int main(int argc, char** argv) {
    keep_standard_streams();
    return taktwerk::apps::run(argc, argv);
}
