# A scene may have any name, and then its default picture could be the scene itself.
echo '{ "halflight": 1, "volumes": [] }' >scene.png
halflight render ./scene.png -o scene.png
