/* The environment that `pelage rib` writes, as the same light from everywhere, without its picture. */
light envlight(float intensity = 1; color lightcolor = 1; uniform string filename = "", name = "", pelage = "";)
{
  Cl = intensity * lightcolor;
}
