# `cpack`, or scripts/package.sh: a .deb of what `cmake --install` installs.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME seedframe)
set(CPACK_PACKAGE_VENDOR "Seedframe maintainers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "labelled image datasets from a scene description and a seed")
set(CPACK_PACKAGE_DESCRIPTION
"Seedframe draws scenes of CAD parts or meshes from a description of what may
vary, renders them with Blender's Cycles, and writes images, exact masks and
annotations in the formats that trainers read (COCO, YOLO, VOC, BOP and others).
Every number of every frame follows from one seed, whatever was killed and
resumed on the way. Labels alone are made without Blender, in seconds.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "Seedframe maintainers <maintainers@seedframe.invalid>")
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# Of the program and of what it opens: without it, no texture is read. Blender lacks numpy, which its own
# package only recommends; bubblewrap is for --sandbox.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "blender (>= 3.4), python3-numpy")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS bubblewrap)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
include(CPack)
