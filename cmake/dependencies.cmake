# Libraries from the system's packages, each with the trap it sets on Debian 12.

find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(glm REQUIRED)
find_package(hwy REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)

# Debian's library of tinygltf brings stb and decodes pictures by it. The header alone does without: it is compiled once,
# in src/scene.
find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)
add_library(tinygltf INTERFACE)
target_include_directories(tinygltf SYSTEM INTERFACE ${TINYGLTF_INCLUDE_DIR})

# A header alone.
find_path(NANOFLANN_INCLUDE_DIR nanoflann.hpp REQUIRED)
add_library(nanoflann INTERFACE)
target_include_directories(nanoflann SYSTEM INTERFACE ${NANOFLANN_INCLUDE_DIR})

# Used as a header alone, too.
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
add_library(xxhash INTERFACE)
target_include_directories(xxhash SYSTEM INTERFACE ${XXHASH_INCLUDE_DIR})

# OpenVDB's find module is not on CMake's own path, and asks for boost's iostreams.
if(CMAKE_LIBRARY_ARCHITECTURE)
    list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)
endif()
list(APPEND CMAKE_MODULE_PATH /usr/lib/cmake/OpenVDB /usr/local/lib/cmake/OpenVDB)
find_package(OpenVDB REQUIRED)

# OpenImageIO's target names OpenCV's include folder, which is not there without OpenCV: keep only folders that exist.
find_package(OpenImageIO CONFIG REQUIRED)
foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
    get_target_property(folders OpenImageIO::OpenImageIO ${property})
    set(existing)
    foreach(folder IN LISTS folders)
        if(EXISTS "${folder}")
            list(APPEND existing "${folder}")
        endif()
    endforeach()
    set_target_properties(OpenImageIO::OpenImageIO PROPERTIES ${property} "${existing}")
endforeach()

# Embree 3 or 4: both call their package and their target "embree".
find_package(embree CONFIG REQUIRED)
