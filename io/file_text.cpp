#include "io/file_text.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "io/errors.hpp"

namespace selvage {

std::string read_file_text(const std::string& path, std::string_view kind)
{
    return read_file_start(path, kind, std::size_t(-1));
}

std::string read_file_start(const std::string& path, std::string_view kind, std::size_t most)
{
    const InputPlace place{path, 0, 0, {}};
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(place, std::filesystem::exists(path, error) ? "something that is not a file" : "no such file",
                         kind);
    std::ifstream stream(path, std::ios::binary);
    std::string text(std::size_t(std::min<std::uintmax_t>(std::filesystem::file_size(path, error), most)), '\0');
    if (!stream || error || !stream.read(text.data(), std::streamsize(text.size())))
        throw InputError(place, "a file that cannot be read", kind);
    return text;
}

}  // namespace selvage
