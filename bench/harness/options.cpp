#include "bench/harness/options.hpp"

#include <algorithm>

namespace selvage {

std::map<std::string, std::string> read_options(const std::string& suite, const std::vector<std::string>& options,
                                                const std::vector<std::string>& names, const std::string& expected)
{
    std::map<std::string, std::string> result;
    for (std::size_t i = 0; i < options.size(); ++i) {
        const std::size_t equals = options[i].find('=');
        const std::string name = options[i].substr(0, equals);
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw InputError({"", 0, 0, suite}, "`" + name + "`", expected, nearest_name(name, names));
        if (equals == std::string::npos && i + 1 == options.size())
            throw InputError({"", 0, 0, name}, "no value", "a value after the option");
        result[name] = equals == std::string::npos ? options[++i] : options[i].substr(equals + 1);
    }
    return result;
}

}  // namespace selvage
