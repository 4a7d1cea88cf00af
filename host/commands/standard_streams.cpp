#include "host/commands/standard_streams.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

#include <fcntl.h>
#include <unistd.h>

namespace selvage {

void hold_standard_descriptors()
{
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
        // The lowest free number is given. The wrong direction makes every use of it fail.
        const int direction = descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY;
        if (open("/dev/null", direction) < 0) open("/", O_RDONLY | O_DIRECTORY);
    }
}

int with_results_printed(int code)
{
    errno = 0;
    std::cout.flush();
    const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout;
    if (!lost) return code;
    // An earlier error has left no number behind; another byte to what is not whole brings it up again.
    if (errno == 0 && write(STDOUT_FILENO, "\n", 1) == 1) errno = 0;
    std::cerr << "selvage: stdout: found " << (errno == 0 ? "an error" : std::strerror(errno))
              << ", expected a place for what is printed: it is lost or not whole\n";
    return code == 0 ? 2 : code;
}

}  // namespace selvage
