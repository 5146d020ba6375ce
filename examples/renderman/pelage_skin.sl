/* Skin below fur: matte, the same on both sides. */
surface pelage_skin(float roughness = 0.5, ior = 1.5; uniform string name = "", model = "", pelage = "";)
{
  normal Nf = faceforward(normalize(N), I);
  color incoming = 0;
  illuminance(P, Nf, PI / 2) incoming += Cl * (normalize(L).Nf);
  Oi = Os;
  Ci = Os * Cs * (incoming / PI + ambient());
}
