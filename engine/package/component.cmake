# What all components of the package have in common: engine, import, renderer, headless, tools.

include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(CANDELA_PACKAGE ${CMAKE_CURRENT_LIST_DIR})
set(CANDELA_GENERATED ${PROJECT_BINARY_DIR}/include)  # public headers that are generated
set(CANDELA_CONFIG_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/candela)
configure_file(${CANDELA_PACKAGE}/version.hpp.in ${CANDELA_GENERATED}/candela/version.hpp @ONLY)
set_property(GLOBAL PROPERTY CANDELA_COMPONENTS "")

# What the libraries of the package are compiled with. Static ones, too, can become part of a host's shared library.
function(candela_library target)
    set_target_properties(${target} PROPERTIES
        POSITION_INDEPENDENT_CODE ON
        CXX_VISIBILITY_PRESET hidden
        VISIBILITY_INLINES_HIDDEN ON)
endfunction()

# candela_component(NAME DESCRIPTION [HEADERS DIRECTORY...]): makes the library candela-NAME the component
# candela::NAME, whose public headers are in the directories. A shared library exports the public API alone: what is
# marked CANDELA_API. The linker script also keeps templates of the standard library out of its symbols.
function(candela_component name description)
    cmake_parse_arguments(PARSE_ARGV 2 component "" "" "HEADERS")
    set(target candela-${name})
    add_library(candela::${name} ALIAS ${target})
    foreach(directory ${component_HEADERS})
        target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${directory}>)
    endforeach()
    target_include_directories(${target} PUBLIC $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    candela_library(${target})
    set_target_properties(${target} PROPERTIES
        EXPORT_NAME ${name}
        VERSION ${PROJECT_VERSION}
        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
        LINK_DEPENDS ${CANDELA_PACKAGE}/exports.map)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL SHARED_LIBRARY)
        target_link_options(${target} PRIVATE
            LINKER:--version-script=${CANDELA_PACKAGE}/exports.map LINKER:--no-undefined)
    endif()
    set_property(GLOBAL APPEND PROPERTY CANDELA_COMPONENTS ${name})
    set_property(GLOBAL PROPERTY CANDELA_DESCRIPTION_${name} ${description})
    set_property(GLOBAL PROPERTY CANDELA_HEADERS_${name} ${component_HEADERS})
endfunction()

# The pkg-config file of a component: what it requires, and what else a static library is to be linked with.
function(candela_install_pkgconfig name)
    cmake_parse_arguments(PARSE_ARGV 1 pc "" "" "REQUIRES;PRIVATE;LIBRARIES")
    get_property(CANDELA_DESCRIPTION GLOBAL PROPERTY CANDELA_DESCRIPTION_${name})
    set(CANDELA_COMPONENT ${name})
    file(RELATIVE_PATH CANDELA_UP /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
    list(JOIN pc_REQUIRES " " CANDELA_REQUIRES)
    list(JOIN pc_PRIVATE " " CANDELA_PRIVATE)
    list(JOIN pc_LIBRARIES " " CANDELA_LIBRARIES)
    configure_file(${CANDELA_PACKAGE}/component.pc.in ${PROJECT_BINARY_DIR}/candela-${name}.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/candela-${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()

# The target `install` for all components: libraries, headers, find_package(candela) and pkg-config.
function(candela_install_package)
    get_property(components GLOBAL PROPERTY CANDELA_COMPONENTS)
    foreach(name ${components})
        get_property(headers GLOBAL PROPERTY CANDELA_HEADERS_${name})
        install(TARGETS candela-${name} EXPORT candela-${name})
        install(EXPORT candela-${name} NAMESPACE candela:: DESTINATION ${CANDELA_CONFIG_FOLDER})
        foreach(directory ${headers})
            install(DIRECTORY ${directory}/candela DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
        endforeach()
    endforeach()

    set(fmt "")
    if(CANDELA_FMT_LIBRARY)
        set(fmt fmt)
    endif()
    candela_install_pkgconfig(engine PRIVATE ${fmt})
    if(TARGET candela-import)
        get_property(codecs GLOBAL PROPERTY CANDELA_CODECS)
        candela_install_pkgconfig(import REQUIRES candela-engine PRIVATE ${fmt} libpng tinygltf stb
            LIBRARIES -ltinyexr ${codecs})
    endif()
    if(TARGET candela-renderer)
        candela_install_pkgconfig(renderer REQUIRES candela-engine PRIVATE ${fmt})
    endif()
    if(TARGET candela-headless)
        candela_install_pkgconfig(headless REQUIRES candela-renderer PRIVATE ${fmt} LIBRARIES -ldl)
    endif()
    if(TARGET candela-tools)
        set(embree "")
        if(embree_FOUND)
            set(embree -lembree${embree_VERSION_MAJOR})
        endif()
        candela_install_pkgconfig(tools REQUIRES candela-renderer PRIVATE ${fmt} stb LIBRARIES -ltinyexr ${embree})
    endif()

    set(CANDELA_EMBREE OFF)
    if(embree_FOUND)
        set(CANDELA_EMBREE ON)
    endif()
    set(CANDELA_STATIC ON)
    if(BUILD_SHARED_LIBS)
        set(CANDELA_STATIC OFF)
    endif()
    configure_package_config_file(
        ${CANDELA_PACKAGE}/candela-config.cmake.in ${PROJECT_BINARY_DIR}/candela-config.cmake
        INSTALL_DESTINATION ${CANDELA_CONFIG_FOLDER})
    write_basic_package_version_file(
        ${PROJECT_BINARY_DIR}/candela-config-version.cmake COMPATIBILITY SameMinorVersion)
    install(FILES ${PROJECT_BINARY_DIR}/candela-config.cmake ${PROJECT_BINARY_DIR}/candela-config-version.cmake
        DESTINATION ${CANDELA_CONFIG_FOLDER})
    install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
endfunction()

# `cpack` makes a relocatable archive of what is installed, and with -G DEB a Debian package.
function(candela_pack)
    set(CPACK_GENERATOR TXZ)
    set(CPACK_PACKAGE_NAME libcandela-dev)
    set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Real-time global illumination by instant radiosity, for OpenGL 4.5")
    set(CPACK_PACKAGE_CONTACT "the Candela authors")
    set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
    set(CPACK_STRIP_FILES ${BUILD_SHARED_LIBS})
    set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
    set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
    set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ${BUILD_SHARED_LIBS})
    set(CPACK_DEBIAN_PACKAGE_DEPENDS "libglm-dev, libpng-dev, libtinygltf-dev, libtinyexr-dev, libstb-dev")
    include(CPack)
endfunction()
