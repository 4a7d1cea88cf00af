# Writes a C++ file that holds every TOML file below FOLDER (see io/presets.hpp):
#     cmake -DFOLDER=io/presets -DOUTPUT=preset_files.cpp -P io/embed_presets.cmake
cmake_minimum_required(VERSION 3.20)

if(NOT FOLDER OR NOT OUTPUT)
    message(FATAL_ERROR "FOLDER and OUTPUT must be given")
endif()

# The C++ standard asks compilers for no more than this in one string literal.
set(literal_limit 65536)
set(entries "")
file(GLOB_RECURSE paths LIST_DIRECTORIES false RELATIVE "${FOLDER}" "${FOLDER}/*.toml")
list(SORT paths)
foreach(path IN LISTS paths)
    file(SIZE "${FOLDER}/${path}" size)
    if(NOT size LESS literal_limit)
        message(FATAL_ERROR "${FOLDER}/${path} has ${size} bytes, a built-in file must be below ${literal_limit}")
    endif()
    file(READ "${FOLDER}/${path}" text)
    string(APPEND entries "    {\"${path}\", R\"preset(${text})preset\"},\n")
endforeach()

file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT [=[
#include "io/presets.hpp"

namespace selvage {
namespace {

constexpr PresetFile files[] = {
@entries@};

}  // namespace

std::span<const PresetFile> preset_files()
{
    return files;
}

}  // namespace selvage
]=])
