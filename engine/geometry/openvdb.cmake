# OpenVDB for the narrow phase distance_field, where it is installed (libopenvdb-dev, libboost-dev): a library of its own that
# geometry/sparse_voxels loads when a scene asks for it. include() this after impinge_engine is defined. OpenVDB's own code
# uses TBB, which the thread sanitizer can't look into.
option(IMPINGE_WITH_OPENVDB "the narrow phase distance_field, where OpenVDB is found" ON)
if(IMPINGE_WITH_OPENVDB AND IMPINGE_THREADS STREQUAL "tbb")
  find_library(OPENVDB_LIB openvdb)
  find_path(OPENVDB_INC openvdb/openvdb.h)
  find_path(BOOST_INC boost/numeric/conversion/conversion_traits.hpp)  # in its headers
  pkg_check_modules(IMATH IMPORTED_TARGET Imath)
  if(OPENVDB_LIB AND OPENVDB_INC AND BOOST_INC AND IMATH_FOUND)
    message(STATUS "OpenVDB: ${OPENVDB_LIB}")
    add_library(impinge_openvdb MODULE engine/geometry/sparse_voxels_openvdb.cpp)
    target_include_directories(impinge_openvdb PRIVATE ${CMAKE_SOURCE_DIR})
    target_include_directories(impinge_openvdb SYSTEM PRIVATE ${OPENVDB_INC})
    target_link_libraries(impinge_openvdb PRIVATE ${OPENVDB_LIB} PkgConfig::IMATH TBB::tbb)
    target_compile_definitions(impinge_engine PUBLIC IMPINGE_OPENVDB)
    target_link_libraries(impinge_engine PRIVATE ${CMAKE_DL_LIBS})
    add_dependencies(impinge_engine impinge_openvdb)
  endif()
endif()
